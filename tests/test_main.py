import runpy
import sys
from pathlib import Path

import pytest

MAIN = Path(__file__).parents[1] / "caretree/__main__.py"


def test_python_m_caretree_is_the_command_line(capsys, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["caretree", "run", "dance"])
    with pytest.raises(SystemExit) as end:
        runpy.run_path(str(MAIN), run_name="__main__")
    assert end.value.code == 2
    assert capsys.readouterr().err.startswith("caretree: unknown task 'dance'")
