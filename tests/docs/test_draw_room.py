"""The picture of the room shows what the room has."""

import runpy
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"


def test_the_picture_is_that_of_the_room_as_it_is(tmp_path):
    script = runpy.run_path(str(DOCS / "draw_room.py"))
    script["draw"](tmp_path / "room.svg")
    now, committed = ((folder / "room.svg").read_text() for folder in (tmp_path, DOCS))
    for name in script["places"]():
        assert f">{name}<" in now
        assert f">{name}<" in committed
    assert now == committed, "python docs/draw_room.py draws it anew"
