import pytest
from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import GownSide
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills.scripted.scripted_perception import scripted_perception

OUTSIDE, INSIDE = (GownSide(stamp=0.0, confidence=1.0, outside=outside) for outside in (True, False))


def test_answers_come_in_turn_with_the_frames_stamp():
    world = ScriptedWorld()
    lost = PerceptionFailure(Problem.NOTHING_SEEN, "the gown")
    eyes = scripted_perception({"side": [INSIDE, lost, lambda frame, outside: OUTSIDE if outside else INSIDE]})
    world.clock.wait_until(2.0)
    frame = world.look("head")
    assert eyes.estimate("side", frame) == GownSide(stamp=2.0, confidence=1.0, outside=False)
    with pytest.raises(PerceptionFailure):
        eyes.estimate("side", frame)
    for outside in (True, False):
        assert eyes.estimate("side", frame, outside=outside).outside is outside


def test_a_script_without_answers_is_refused():
    with pytest.raises(ValueError, match="at least one answer"):
        scripted_perception({"side": []})
