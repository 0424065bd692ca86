"""What is on the board is shown as plain values, whatever it is."""

from dataclasses import dataclass

import msgpack
import numpy as np
from caretree.trees.groot.plain import plain


@dataclass
class Arm:
    side: str
    points: np.ndarray


def test_values_become_plain():
    arm = Arm("left", np.zeros((2, 3)))
    values = {
        "arm": arm,
        "many": np.zeros((10, 10), np.float32),
        "number": np.float64(0.5),
        "whole": np.int32(3),
        "lost": float("nan"),
        "huge": 2**70,
        "none": None,
        "pair": (True, "yes"),
        "thing": object,
    }
    shown = {name: plain(value) for name, value in values.items()}
    assert shown["arm"] == {"side": "left", "points": [[0.0] * 3] * 2}
    assert shown["many"] == "array (10, 10) of float32"
    assert (shown["number"], shown["whole"], shown["lost"], shown["huge"]) == (0.5, 3, "nan", str(2**70))
    assert (shown["none"], shown["pair"], shown["thing"]) == (None, [True, "yes"], "<class 'object'>")
    assert msgpack.unpackb(msgpack.packb(shown)) == shown


def test_what_holds_itself_comes_to_an_end():
    chain: list[object] = []
    chain.append(chain)
    assert "[...]" in str(plain(chain))
    assert len(plain(["x"] * 500)) <= 200
