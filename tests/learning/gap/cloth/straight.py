"""A cloth that moves in proportion to every number of every effect, each number in a pattern of its own."""

import numpy as np
from caretree.learning.gap.cloth.simulate import READING, SIZES

NOISE = 1e-3
ALIKE = {"wind": "tilted_gravity", "x": "towards_x", "y": "towards_y"}  # what does the same here
UNIT = {"tilted_gravity": 0.03, "offset": 0.003, "delay": 0.01}  # a size that moves the markers by `NOISE`


class Straight:
    def __init__(self, rows):
        self.rows = rows

    def pattern(self, effect, parameter):
        key = [ord(x) for x in ALIKE.get(effect, effect) + ALIKE.get(parameter, parameter)]
        return NOISE * np.random.default_rng(key).normal(size=(self.rows, 18))

    def run(self, episode, effects=(), physics=None):
        out = np.zeros((self.rows, 18))
        for e in effects:
            for p, x in e.parameters.items():
                if p in SIZES.get(e.name, ()) or e.name in READING:
                    out += x / UNIT.get(e.name, 1.0) * self.pattern(e.name, p)
        for p, x in (physics or {}).items():
            out += x * self.pattern("physics", p)
        return out

    def ahead(self, wanted):
        pass
