"""The dressing world as a `System`: near one set of values its loads are straight in the effects' numbers.

The robot moves as it did, whatever the model, so a load is nearly straight in mass, friction, damping and stiffness, as
inverse dynamics is.  The world is therefore simulated at the values found so far and beside them, and in between its
answer is the straight one; `DressingStudy` does so again at the values found, until they stand still.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ....sim.effects.dressing.dressing_registry import DRESSING_EFFECTS
from ....sim.effects.effect import Parameter
from ....sim.effects.model_file import EffectEntry
from ....sim.record.recorded_stretch import Stretch
from ....sim.world import SIDES
from ..own.system import Columns, Effect, System
from .loads import CHANNELS, HAND, TURN, LoadPredictions

STEP = 0.5  # of the typical size, from the values found so far upwards
BIAS = "load_cell_bias"


@dataclass(frozen=True, kw_only=True)
class _Near:
    """One stretch near one set of values: loads of the model as given, there, and per parameter, (T, 3) each [N]."""

    given: np.ndarray
    there: np.ndarray
    slopes: dict[str, np.ndarray]


class DressingSystem(System):
    """See above.

    Args:
        stretches: by the number that the column `window` has.
        predictions: of the world.
    """

    name = "dressing"
    channels = dict.fromkeys(CHANNELS, "N")
    # [N]; of eight of twelve records without any effect the replay leaves 0.03 to 0.26 N (docs/close-a-gap.md)
    model_error = dict.fromkeys(CHANNELS, 0.25)
    effects: tuple[Effect, ...] = ()

    def __init__(self, stretches: Sequence[Stretch], predictions: LoadPredictions) -> None:
        self._stretches, self._predictions = stretches, predictions
        with_cloth = any(s.held.cloth[:, s.hand].any() for s in stretches)
        with_arm = any((s.held.part[:, s.hand] >= 0).any() for s in stretches)
        self.effects = tuple(  # type: ignore[misc] - a class's for other systems
            _effect(name, target)
            for name, effect in DRESSING_EFFECTS.items()
            for target in effect.targets
            if name == BIAS or (with_cloth if effect.on_cloth else with_arm)
        )
        self._simulated = [e for e in self.effects if e.regressor is None]
        self._parameters = {p.name: p for e in self._simulated for p in e.parameters}
        self.centre: dict[str, float] = {}
        self._near: list[_Near] = []

    def move_to(self, values: Mapping[str, float]) -> None:
        """Simulate at these values and beside them."""
        self.centre = {name: float(values[name]) for name in self._parameters}
        self._near = [self._around(stretch) for stretch in self._stretches]

    def _around(self, stretch: Stretch) -> _Near:
        there, slopes = self._load(stretch, self.centre), {}
        for name, p in self._parameters.items():
            step = STEP * p.typical if self.centre[name] + STEP * p.typical <= p.upper else -STEP * p.typical
            beside = self._load(stretch, {**self.centre, name: self.centre[name] + step})
            slopes[name] = (beside - there) / step
        return _Near(given=self._load(stretch, dict.fromkeys(self.centre, 0.0)), there=there, slopes=slopes)

    def _load(self, stretch: Stretch, values: Mapping[str, float]) -> np.ndarray:
        return self._predictions.load(stretch, entries(self._simulated, values))

    def predict(self, log: Columns, values: Mapping[str, float]) -> np.ndarray:
        """Straight between what was simulated: exact at the model as given and at the values moved to."""
        near = self._near[int(log["window"][0])]

        def straight(at: Mapping[str, float]) -> np.ndarray:
            return near.there + sum(
                (slope * (at[name] - self.centre[name]) for name, slope in near.slopes.items()), np.zeros((1, 3))
            )

        unit = {name: p.typical for name, p in self._parameters.items()}
        away = sum((x / unit[name]) ** 2 for name, x in self.centre.items())
        along = sum(values[name] * x / unit[name] ** 2 for name, x in self.centre.items()) / away if away else 0.0
        bend = near.given - straight(dict.fromkeys(self.centre, 0.0))
        return straight(values) + bend * (1.0 - min(max(along, 0.0), 1.0))

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


def _effect(name: str, target: str) -> Effect:
    effect = DRESSING_EFFECTS[name]
    if name != BIAS:
        return Effect(name=name, target=target, parameters=effect.parameters)
    named: tuple[Parameter, ...] = tuple(replace(p, name=f"{target}_{p.name}") for p in effect.parameters)
    hand = float(SIDES.index(target.removesuffix("_hand")))  # type: ignore[arg-type] - one of them

    def felt(log: Columns) -> np.ndarray:
        """(T, 3, 3) the hand's axes in the map, where it is this hand's load."""
        turn = np.stack([log[c] for c in TURN], axis=1).reshape(-1, 3, 3)
        return turn * (log[HAND] == hand)[:, None, None]

    return Effect(name=name, target=target, parameters=named, regressor=felt)
