"""What authors import from the two faces is there, and every leaf is among it."""

import subprocess
import sys

import caretree.skills
import caretree.trees
import pytest
from caretree.trees.commands.skills import all_skills


@pytest.mark.parametrize("face", [caretree.skills, caretree.trees], ids=lambda face: face.__name__)
def test_everything_that_is_promised_can_be_imported(face):
    assert all(getattr(face, name).__name__ == name for name in face.__all__ if name != "Policy")
    with pytest.raises(AttributeError, match="no attribute 'Nothing'"):
        _ = face.Nothing


def test_every_leaf_is_promised():
    assert {kind.__name__ for kind in all_skills().values()} <= set(caretree.skills.__all__)


def test_the_faces_load_nothing_heavy():
    code = "import sys, caretree.skills, caretree.trees; print({'numpy', 'py_trees', 'pybullet'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
