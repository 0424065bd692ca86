"""The pre-grasp proposal from six views."""

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure
from caretree.perception.gown.pregrasp import pregrasp_proposal

TURNS = np.arange(6) * np.pi / 6


def views(scenes, seed):
    turned = [scenes.in_hand(seed, turn) for turn in TURNS]
    return turned, [s.frame(k) for k, s in enumerate(turned)], [s.hand for s in turned]


def test_six_views_find_a_corner(scenes):
    errors = []
    for seed in range(4):
        turned, frames, hands = views(scenes, seed)
        proposal = pregrasp_proposal(frames, hands)
        corners = turned[proposal.view].vertices[list(scenes.in_hand(seed).gown.corners)]
        errors.append(np.linalg.norm(corners - proposal.corner_in_map, axis=1).min())
        assert np.linalg.norm(proposal.sweep_in_map) == pytest.approx(0 if proposal.primitive == "direct" else 0.05)
        assert proposal.sweep_in_map @ proposal.approach_in_map == pytest.approx(0, abs=1e-9)
        np.testing.assert_allclose(proposal.position_in_map + proposal.sweep_in_map / 2, proposal.corner_in_map)
    assert sorted(errors)[2] < 0.06  # three of four; the vertex is half a binding's width above what is aimed at


def test_places_tried_in_vain_are_left_alone(scenes):
    _, frames, hands = views(scenes, 0)
    first = pregrasp_proposal(frames, hands)
    pose = hands[first.view]
    tried = pose[:3, :3].T @ (first.corner_in_map - pose[:3, 3])
    second = pregrasp_proposal(frames, hands, exclude=[tried])
    pose = hands[second.view]
    assert np.linalg.norm(pose[:3, :3].T @ (second.corner_in_map - pose[:3, 3]) - tried) > 0.07


def test_nothing(black):
    with pytest.raises(PerceptionFailure):
        pregrasp_proposal([black] * 6, [np.eye(4)] * 6)
