"""The drawing of a tree says what a reader of the task file wants to know."""

from caretree.trees.proof.check import fresh_tree
from caretree.trees.proof.draw import drawn
from caretree.trees.run.task import load_task


def test_the_tree_of_wave():
    lines = drawn(fresh_tree(load_task("wave")))
    assert lines[0] == "wave safely  (FailSafe)"
    assert lines[-1] == "  if it fails: let go  (Retreat)"
    assert "          if COMMAND_LOST: wait  (HoldStill)" in lines
    assert "            hand up  (MoveJoint; writes wave_before)" in lines
    assert "            hand back  (MoveJoint; reads wave_before)" in lines
    stage = lines.index("    wave  (Stage)")
    assert lines[stage + 1] == "      first: wave: pre-condition  (Condition)"
