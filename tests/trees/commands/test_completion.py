import re
import shutil
import subprocess

import pytest
from caretree.trees.cli import SHELLS, build_parser, main
from caretree.trees.commands.completion import script, words
from caretree.trees.tasks import task_names


def completed(folder, *line):
    """What bash offers for the last word of a command line."""
    asks = 'COMP_WORDS=("$@"); COMP_CWORD=$(($#-1)); _caretree; printf \'%s\\n\' "${COMPREPLY[@]}"'
    found = subprocess.run(
        ["bash", "--norc", "-c", f"{script('bash')}\n{asks}", "bash", "caretree", *line],
        capture_output=True,
        text=True,
        cwd=folder,
        check=True,
    )
    assert not found.stderr
    return [word for word in found.stdout.splitlines() if word]


@pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not here")
@pytest.mark.parametrize(
    ("line", "offered"),
    [
        (["chec"], ["check"]),
        (["--ver"], ["--version"]),
        (["run", "dre"], ["dressing"]),
        (["run", "fe"], ["fetch.py", "fetch.xml"]),
        (["run", "wave", "--world", ""], ["bullet", "scripted"]),
        (["run", "wave", "--world-kind", "easy+f"], ["easy+falling_arms"]),
        (["run", "wave", "--out", "f"], ["folder"]),
        (["run", "wave", "--tuning", "fetch.y"], ["fetch.yaml"]),
        (["inject", "wave", "--sam"], ["--sample"]),
        (["skills", "lift"], ["lift_arm"]),
        (["report", "f"], ["folder"]),
        (["trials", "wave", "--jo"], ["--jobs"]),
        (["new", "w"], []),
    ],
)
def test_bash_offers_what_may_stand_there(line, offered, tmp_path):
    for name in ("fetch.py", "fetch.xml", "fetch.yaml"):
        (tmp_path / name).touch()
    (tmp_path / "folder").mkdir()
    assert completed(tmp_path, *line) == offered


@pytest.mark.parametrize("shell", SHELLS)
def test_every_command_option_and_task_is_in_the_script(shell, capsys):
    assert main(["completion", shell]) == 0
    text = capsys.readouterr().out
    for name, command in words().items():
        assert re.search(rf"[ \"]{name} ", text)
        assert all(option in text for option in command.options)
    assert all(task in text for task in task_names())
    assert {"check", "run", "trials", "evaluate", "gap"} <= words().keys()
    assert "--jobs" in words()["trials"].options, "commands that parse for themselves are there too"


def test_an_unknown_shell_is_refused(capsys):
    assert main(["completion", "fish"]) == 2
    assert "choose from 'bash', 'zsh'" in capsys.readouterr().err


def test_no_command_is_unknown_to_the_parser():
    parser = build_parser()
    for name in words():
        assert name in parser.format_help()


def test_what_the_forms_of_a_command_take_is_offered_too():
    export = words()["export"]
    assert {"xml", "lerobot", "wave"} <= set(export.places.words)
    assert {"--out", "--stage", "--camera"} <= set(export.options)


def test_engines_and_robots_are_offered_by_name():
    options = words()["run"].options
    assert options["--engine"].words == ("bullet", "spring", "spring-layers")
    assert options["--robot"].words == ("baxter", "ur5-pair")
