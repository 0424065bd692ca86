"""The dressing world as a `System`: near one set of values its loads are straight in the effects' numbers.

The robot moves as it did, whatever the model, so a load is nearly straight in mass, friction, damping and stiffness, as
inverse dynamics is.  The world is therefore simulated at the values found so far and beside them, and in between its
answer is the straight one; `DressingStudy` does so again at the values found, until they stand still.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from ....sim.effects.dressing.dressing_registry import DRESSING_EFFECTS
from ....sim.effects.effect import Parameter
from ....sim.effects.model_file import EffectEntry
from ....sim.record.recorded_stretch import Stretch
from ....sim.world import SIDES
from ..own.system import Columns, Effect, System
from .loads import CAMERA, CHANNELS, DELAY, HAND, SEEN, TURN, Predictions, last_look

STEP = 0.5  # of the typical size, from the values found so far upwards
BIAS, OFFSET = "load_cell_bias", "camera_offset"  # the prediction is linear in these
PULLED = 0.05  # what the replay leaves along an axis where a sleeve is pulled, nothing is missing and no arm held [N]
DRAG = Parameter(name="grip_drag", unit="m", lower=-0.003, upper=0.003, typical=0.001)  # of the closing fingers
DRAGS = (-0.003, -0.001, 0.0, 0.001, 0.003)  # that are simulated first; an arm's joints slip from 1 to 2 mm on [m]


@dataclass(frozen=True, kw_only=True)
class _Near:
    """One stretch near one set of values.

    Attributes:
        given: (T, C) channels of the model as given.
        there: the same at the values.
        slopes: of each parameter: the same for each of its unit, below its value and above.
        drags: (k,) of the fingers, that were simulated [m].
        dragged: (k, T, C) what they add there.
    """

    given: np.ndarray
    there: np.ndarray
    slopes: dict[str, tuple[np.ndarray, np.ndarray]]
    drags: np.ndarray
    dragged: np.ndarray

    def drag(self, drag: float) -> np.ndarray:
        """(T, C) what a drag [m] adds, straight between those that were simulated."""
        k = int(np.searchsorted(self.drags[1:-1], drag))
        share = (drag - self.drags[k]) / (self.drags[k + 1] - self.drags[k])
        return (1.0 - share) * self.dragged[k] + share * self.dragged[k + 1]


class DressingSystem(System):
    """See above.

    Args:
        stretches: by the number that the column `window` has.
        predictions: of the world.
    """

    name = "dressing"
    channels: ClassVar = {**dict.fromkeys(CHANNELS, "N"), **dict.fromkeys(SEEN, "m")}
    # [N]: of 24 records without any effect the replay leaves 0.03 to 0.05 an axis, but for five with up to 0.3, whose
    # fingers strained the arm, and 0.12 upwards, where it has a tenth too much of what grows with speed, as no servo
    # shakes it.  [m]: in eight such records wrists are seen 0 to 4 mm off (docs/close-a-gap.md)
    model_error: ClassVar = {"fx": 0.2, "fy": 0.2, "fz": 0.3, **dict.fromkeys(SEEN, 0.004)}
    effects: tuple[Effect, ...] = ()

    def __init__(self, stretches: Sequence[Stretch], predictions: Predictions) -> None:
        self._stretches, self._predictions = stretches, predictions
        with_cloth = any(s.held.cloth[:, s.hand].any() for s in stretches)
        with_arm = any(s.held_arm >= 0 for s in stretches)
        seen = all(last_look(s) is not None for s in stretches)
        if not seen:
            self.channels = dict.fromkeys(CHANNELS, "N")  # type: ignore[misc] - a class's for other systems
        if not with_arm:
            self.model_error = dict.fromkeys(CHANNELS, PULLED)  # type: ignore[misc]
        self.effects = tuple(  # type: ignore[misc] - a class's for other systems
            self._effect(name, target)
            for name, effect in DRESSING_EFFECTS.items()
            for target in effect.targets
            if name in (BIAS, DELAY) or (seen if name == OFFSET else with_cloth if effect.on_cloth else with_arm)
        )
        self.start = (DRAG,) if with_arm else ()  # type: ignore[misc]
        self._simulated = [e for e in self.effects if e.regressor is None]
        self._parameters = {p.name: p for e in self._simulated for p in e.parameters}
        self.centre: dict[str, float] = {}
        self._near: list[_Near] = []

    def _effect(self, name: str, target: str) -> Effect:
        effect = DRESSING_EFFECTS[name]
        if name not in (BIAS, OFFSET):
            return Effect(name=name, target=target, parameters=effect.parameters)
        named: tuple[Parameter, ...] = tuple(replace(p, name=f"{target}_{p.name}") for p in effect.parameters)
        hand = SIDES.index(target.removesuffix("_hand")) if name == BIAS else -1  # type: ignore[arg-type] - one of them
        first = 0 if name == BIAS else len(CHANNELS)

        def told(log: Columns) -> np.ndarray:
            """(T, C, 3) axes of the hand in the map, where it is this hand's load, or of the camera, turned round."""
            turn = np.stack([log[c] for c in (TURN if name == BIAS else CAMERA)], axis=1).reshape(-1, 3, 3)
            out = np.zeros((len(turn), len(self.channels), 3))
            out[:, first : first + 3] = turn * (log[HAND] == hand)[:, None, None] if name == BIAS else -turn
            return out

        return Effect(name=name, target=target, parameters=named, regressor=told)

    def move_to(self, values: Mapping[str, float], drags: Sequence[float] | None = None) -> None:
        """Simulate at these values and beside them, and with these drags of the fingers, one a stretch [m]."""
        self.centre = {name: float(values[name]) for name in self._parameters}
        drags = drags or [0.0] * len(self._stretches)
        self._near = [self._around(stretch, drag) for stretch, drag in zip(self._stretches, drags, strict=True)]

    def _around(self, stretch: Stretch, drag: float) -> _Near:
        there, slopes = self._load(stretch, self.centre), {}
        for name, p in self._parameters.items():
            slopes[name] = self._slopes(stretch, there, name, p)
        given = self._load(stretch, dict.fromkeys(self.centre, 0.0))
        drags = sorted({*DRAGS, drag}) if stretch.held_arm >= 0 else [DRAG.lower, DRAG.upper]
        added = [self._load(stretch, self.centre, x) - there if stretch.held_arm >= 0 else 0.0 * there for x in drags]
        return _Near(given=given, there=there, slopes=slopes, drags=np.array(drags), dragged=np.stack(added))

    def _slopes(
        self, stretch: Stretch, there: np.ndarray, name: str, parameter: Parameter
    ) -> tuple[np.ndarray, np.ndarray]:
        """Slopes below and above a value; the same where one side has to do.

        What is absent may have either sign, and cloth that is softer than it should be hangs otherwise than one that is
        stiffer: by the slope of the latter, the former was not found, and a delay named for it.
        """
        value, step = self.centre[name], STEP * parameter.typical
        sides = [s for s in (step, -step) if parameter.lower <= value + s <= parameter.upper]
        sides = sides if value == 0.0 else sides[:1]
        found = [(self._load(stretch, {**self.centre, name: value + s}) - there) / s for s in sides]
        return found[-1], found[0]

    def _load(self, stretch: Stretch, values: Mapping[str, float], drag: float = 0.0) -> np.ndarray:
        found = self._predictions.of(stretch, entries(self._simulated, values), drag)
        return found[:, : len(self.channels)]

    def predict(self, log: Columns, values: Mapping[str, float]) -> np.ndarray:
        """Straight between what was simulated: exact at the model as given and at the values moved to."""
        near = self._near[int(log["window"][0])]

        def straight(at: Mapping[str, float]) -> np.ndarray:
            away = {name: at[name] - x for name, x in self.centre.items()}
            moved = (sides[int(away[name] > 0.0)] * away[name] for name, sides in near.slopes.items())
            return near.there + sum(moved, np.zeros((1, len(self.channels))))

        unit = {name: p.typical for name, p in self._parameters.items()}
        away = sum((x / unit[name]) ** 2 for name, x in self.centre.items())
        along = sum(values[name] * x / unit[name] ** 2 for name, x in self.centre.items()) / away if away else 0.0
        bend = near.given - straight(dict.fromkeys(self.centre, 0.0))
        return straight(values) + bend * (1.0 - min(max(along, 0.0), 1.0)) + near.drag(values.get(DRAG.name, 0.0))

    def experiments(self, log: Columns) -> dict[str, Columns]:
        """None: another motion would have to be recorded, for instance another lift."""
        return {}


def entries(effects: Sequence[Effect], values: Mapping[str, float]) -> tuple[EffectEntry, ...]:
    """Those effects that are not absent, as a model file has them."""
    out = []
    for e in effects:
        own = {p.name.removeprefix(f"{e.target}_"): float(values[p.name]) for p in e.parameters}
        if any(own.values()):
            out.append(EffectEntry(name=e.name, target=e.target, parameters=own))
    return tuple(out)
