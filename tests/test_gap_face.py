"""`caretree.gap` offers what it says, and costs nothing until it is used."""

import subprocess
import sys

import pytest

import caretree.gap


@pytest.mark.parametrize("name", caretree.gap.__all__)
def test_every_name_is_there(name):
    assert getattr(caretree.gap, name).__doc__


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'Sytem'"):
        _ = caretree.gap.Sytem


def test_importing_it_imports_no_numpy():
    code = "import sys, caretree.gap; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
