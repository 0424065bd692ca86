"""Trees in XML that are damaged at random: each is refused in one sentence, or checked; none is a traceback."""

import random
import re

import pytest
from caretree.trees.cli import main
from caretree.trees.commands.export import exported
from caretree.trees.run.task import load_task

WORD = re.compile(r'[A-Za-z_]+|"[^"]*"|<[^>]*>')
STRANGE = (
    '"{x}"',
    '"{=}"',
    '"{@x}"',
    '"json:{}"',
    '"nan"',
    '"-1"',
    '"1e999"',
    '"\u202e"',
    "&#0;",
    '""',
    '<SubTree ID="Task"/>',
)


def damaged(rng, text):
    """The text with one word replaced, left out or doubled, or one letter changed."""
    found = rng.choice(list(WORD.finditer(text)))
    how = rng.randrange(4)
    if how == 0:
        words = [*STRANGE, *WORD.findall(text)]
        return text[: found.start()] + rng.choice(words) + text[found.end() :]
    if how == 1:
        return text[: found.start()] + text[found.end() :]
    if how == 2:
        return text[: found.end()] + found.group() + text[found.end() :]
    at = rng.randrange(len(text))
    return text[:at] + rng.choice("<>&\"'{};/= \0é") + text[at + 1 :]


@pytest.mark.parametrize("seed", range(100, 104))
def test_no_damage_is_a_traceback(seed, tmp_path, capsys):
    rng = random.Random(seed)
    text = exported(load_task("wave"), folder=tmp_path).partition("<TreeNodesModel>")[0] + "</root>"
    path = tmp_path / "wave.xml"
    for _ in range(40):
        path.write_text(damaged(rng, text), errors="replace")
        status = main(["check", str(path)])
        error = capsys.readouterr().err
        assert status in (0, 1, 2)
        assert error.count("\n") == (status == 2), error
        assert status != 2 or re.match(r"caretree: .*wave\.xml:\d+: ", error), error
