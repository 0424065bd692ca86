"""Where to stand to lift an arm and to take its sleeve."""

from dataclasses import replace

import numpy as np
import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.skills.belief.refused_stands import refused_stands
from caretree.skills.find_stand import FindStand
from caretree.skills.geometry.stances import stance
from caretree.skills.scripted.scripted_person import laid_strap, lying_posture

from .bench import LeafBench, beside_bed


def chosen(sleeve, *, refused=()):
    """The base pose (3,) for an arm at rest and a sleeve that is seen, or not; it was out of reach from `refused`."""
    lies = lying_posture("right")

    def stands(context):
        skill = FindStand("stand", context, side="right", lifting="left", pulling="right")
        refused_stands(skill, "right").extend(refused)
        return skill

    run = LeafBench(
        stands,
        beside_bed(sleeve_opening=sleeve, arm=lies, relocalised_arm=lies),
    )
    assert run.ended(seconds=4.0) is None
    return run.skill.stand


def moved(offset):
    strap = laid_strap("right")
    return replace(strap, position_in_map=strap.position_in_map + offset)


def test_the_usual_stance_will_do():
    np.testing.assert_allclose(chosen(moved((-0.12, 0.0, 0.0))), stance("right", "lift"))


def test_from_where_the_sleeve_was_out_of_reach_it_is_not_tried_again():
    usual = stance("right", "lift")
    elsewhere = chosen(moved((-0.12, 0.0, 0.0)), refused=[usual])
    assert np.linalg.norm(elsewhere - usual) > 0.05  # [m]
    third = chosen(moved((-0.12, 0.0, 0.0)), refused=[usual, elsewhere])
    assert min(np.linalg.norm(third - there) for there in (usual, elsewhere)) > 0.05


def test_a_sleeve_at_the_robots_feet_makes_it_stand_elsewhere():
    base = chosen(moved((0.10, -0.35, 0.0)))
    assert np.linalg.norm(base - stance("right", "lift")) > 0.05
    assert base[2] == pytest.approx(stance("right", "lift")[2])


def test_a_sleeve_out_of_sight_changes_nothing():
    hidden = PerceptionFailure(Problem.NOTHING_SEEN, "sleeve")
    np.testing.assert_allclose(chosen(hidden), stance("right", "lift"))
