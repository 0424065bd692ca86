"""The drawing of a tree says what a reader of the task file wants to know."""

from caretree.trees.check import fresh_tree
from caretree.trees.draw import drawn
from caretree.trees.tasks import load_task


def test_the_tree_of_wave():
    lines = drawn(fresh_tree(load_task("wave")))
    assert lines[0] == "wave safely  (FailSafe)"
    assert lines[-1] == "  if it fails: let go  (LetGo)"
    assert "          if COMMAND_LOST: wait  (Hold)" in lines
    assert "            hand up  (MoveJoint; writes wave_before)" in lines
    assert "            hand back  (ReturnJoint; reads wave_before)" in lines
    stage = lines.index("    wave  (Stage)")
    assert lines[stage + 1] == "      first: wave: pre-condition  (Condition)"
