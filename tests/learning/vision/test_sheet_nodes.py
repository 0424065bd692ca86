"""Places on the sheet as weights of nodes, and back."""

import numpy as np
from caretree.learning.vision.sheet_nodes import SHEET_NODES, node_weights
from caretree.perception.learned.sight import places_on_sheet
from caretree.sim.scene.gown import GOWNS, HELD_OUT_GOWNS, build_gown

NODES = [np.asarray(axis) for axis in SHEET_NODES]


def places(count=40):
    rng = np.random.default_rng(0)
    ends = np.array([(axis[0], axis[-1]) for axis in SHEET_NODES])
    return rng.uniform(ends[:, 0], ends[:, 1], (count, 3)).T[:, :, None]


def test_every_cut_lies_within_the_nodes():
    for spec in (*GOWNS.values(), *HELD_OUT_GOWNS.values()):
        for axis, nodes in zip(build_gown(spec).vertices.T, SHEET_NODES, strict=True):
            assert nodes[0] <= axis.min() + 1e-6
            assert axis.max() - 1e-6 <= nodes[-1]


def test_two_nodes_share_a_coordinate():
    for weights in node_weights(places()):
        assert np.allclose(weights.sum(axis=0), 1.0, atol=1e-5)
        assert (weights > 0).sum(axis=0).max() <= 2


def test_where_there_is_no_place_nothing_is_wanted():
    assert all(weights.max() == 0.0 for weights in node_weights(np.full((3, 2, 2), np.nan)))


def test_what_is_read_off_exact_scores_is_the_place():
    wanted = places()
    scores = np.log(np.concatenate(node_weights(wanted)) + 1e-6)
    assert np.abs(places_on_sheet(scores, NODES) - wanted.transpose(1, 2, 0)).max() < 2e-3


def test_left_and_right_are_not_averaged():
    scores = np.full((sum(map(len, NODES)), 1, 1), -9.0)
    scores[[1, 17], 0, 0] = (3.0, 2.9)  # -0.8 m or 0.8 m
    assert abs(places_on_sheet(scores, NODES)[0, 0, 0] + 0.8) < 0.01
