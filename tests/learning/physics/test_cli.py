import importlib.util

from caretree.learning.physics.cli import COMMANDS
from caretree.trees.cli import main


def test_help_names_every_part_and_command(capsys):
    assert main(["learn"]) == main(["learn", "physics", "--help"]) == 0
    out = capsys.readouterr().out
    assert "physics" in out
    assert all(f"\n  {command} " in out for command in COMMANDS)


def test_a_command_of_a_later_version_is_told(monkeypatch, capsys):
    monkeypatch.setattr(importlib.util, "find_spec", lambda *_: None)
    assert main(["learn", "physics", "train"]) == 2
    assert "`caretree learn physics train` is not in this version" in capsys.readouterr().err
