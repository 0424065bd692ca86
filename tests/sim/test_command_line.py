"""A user's mistake is one sentence, whichever command line he met."""

import argparse
import errno
import os

import pytest
from caretree.sim.command_line import CommandParser, answered, drop_output, picture_file, seed, whole_number
from caretree.sim.errors import CaretreeError


def parser():
    top = CommandParser(prog="tool")
    sub = top.add_subparsers(dest="command", required=True)
    run = sub.add_parser("run")
    run.add_argument("--seed", type=seed, default=0)
    run.add_argument("--steps", type=whole_number, default=1)
    run.add_argument("--picture", type=picture_file)
    return top


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], r"required: command \(see tool --help\)"),
        (["run", "--seed", "-1"], r"'-1' is no seed: a whole number from 0 to 4294967295 .* \(see tool run --help\)"),
        (["run", "--seed", "4294967296"], "is no seed"),
        (["run", "--seed", "\u0661"], "is no seed"),
        (["run", "--steps", "1.5"], "'1.5' is no whole number"),
        (["run", "--picture", "s.xyz"], r"'s.xyz' is no picture; it may end in .png, .jpg, .* \(see tool run --help\)"),
        (["run", "--picture", "s"], "'s' is no picture"),
        (["run", "--picture", ""], r"nothing is given with --picture \(see tool --help\)"),
        (["run", "--steps="], "nothing is given with --steps"),
        ([""], "nothing is given with tool"),
        (["run", "--stepz", "1"], "unrecognized arguments: --stepz 1"),
    ],
)
def test_a_wrong_argument_is_one_sentence(arguments, said):
    with pytest.raises(CaretreeError, match=said) as caught:
        parser().parse_args(arguments)
    assert "\n" not in str(caught.value)


def test_right_arguments_are_numbers():
    assert parser().parse_args(
        ["run", "--seed", "4294967295", "--steps", "3", "--picture", "lab/s.PNG"]
    ) == argparse.Namespace(command="run", seed=4294967295, steps=3, picture="lab/s.PNG")


@pytest.mark.parametrize(
    ("problem", "status", "said"),
    [
        (CaretreeError("it is broken"), 2, "tool: it is broken\n"),
        (FileNotFoundError(2, "No such file or directory", "a.txt"), 2, "tool: No such file or directory: a.txt\n"),
        (OSError("odd"), 2, "tool: odd\n"),
        (KeyboardInterrupt(), 130, "tool: interrupted; all is kept\n"),
    ],
)
def test_what_goes_wrong_is_told_and_gives_its_exit_status(problem, status, said, capsys):
    def command():
        raise problem

    assert answered("tool", command, interrupted="interrupted; all is kept") == status
    assert capsys.readouterr().err == said


@pytest.mark.parametrize("problem", [CaretreeError("it is broken"), OSError("odd"), KeyboardInterrupt()])
def test_a_terminal_that_has_gone_changes_no_exit_status(problem, monkeypatch, capsys):
    class Gone:
        def write(self, text):
            raise OSError(errno.EIO, "Input/output error")

        flush = write

    def command():
        raise problem

    status = answered("tool", command)
    monkeypatch.setattr("sys.stderr", Gone())
    assert answered("tool", command) == status


def test_what_is_printed_after_its_reader_has_gone_is_dropped(monkeypatch, capsys):
    drop_output()  # no file stands behind what pytest captures
    read, write = os.pipe()
    os.close(read)
    with open(write, "w") as stream:
        monkeypatch.setattr("sys.stdout", stream)
        with pytest.raises(BrokenPipeError):
            print("lost", flush=True)
        drop_output()
        print("lost", flush=True)


def test_a_command_keeps_its_own_exit_status_and_a_programming_error_its_traceback(capsys):
    assert answered("tool", lambda: 7) == 7
    with pytest.raises(ZeroDivisionError):
        answered("tool", lambda: 1 // 0)
    assert capsys.readouterr().err == ""


def test_a_sentence_stays_one_line_whatever_the_user_wrote(capsys):
    def refuse():
        raise CaretreeError("no task 'a\nb\u202e\x1b[31m'")

    assert answered("caretree", refuse) == 2
    assert capsys.readouterr().err == "caretree: no task 'a\\nb\\u202e\\x1b[31m'\n"
