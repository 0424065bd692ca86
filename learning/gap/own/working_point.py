"""A user's system near one set of values, in the form the search of joints works with: logs, and columns of effects.

Near the values theta* the prediction is f(theta*) + J (theta - theta*).  So `measured - f(theta*) + J theta*` is what
the effects have to explain, J their columns and theta their whole size; at theta* it leaves what simulating leaves.
"""

from __future__ import annotations

import numpy as np

from ..joints.block import Block
from ..joints.log import JointLog
from .simulation import Recording, Simulation, Values
from .system import Effect

SLOW = 2e-3  # of the usual rate of change, below which its sign is not known


class WorkingPoint:
    """Logs and columns at one set of values.

    Attributes:
        values: where.
        blocks: every effect of the system that changes its prediction there, in order.
    """

    def __init__(self, sim: Simulation, values: Values) -> None:
        self._sim, self.values = sim, values
        self._recordings: dict[str, Recording] = {r.episode.name: r for r in sim.recordings}
        self._columns: dict[tuple[str, str, str], np.ndarray] = {}
        self.logs = [self.log(r) for r in sim.recordings]
        self.blocks = [b for b in (self._block(e) for e in sim.system.effects) if self._acts(b)]

    def log(self, r: Recording) -> JointLog:
        """A recording as the search sees it: the channels stand where joints do, the prediction is their motion."""
        self._recordings[r.episode.name] = r
        acting = [e for e in self._sim.system.effects if any(self.values[p.name] for p in e.parameters)]
        predicted, residual = self._sim.predict(r, self.values), self._sim.left(r, self.values)
        for e in acting:
            residual = residual + self._column(r, e) @ np.array([self.values[p.name] for p in e.parameters])
        t = r.t
        rate = np.gradient(predicted, t, axis=0)
        inputs = [r.columns[name][r.pick] for name in self._sim.system.inputs]
        pushed = np.stack([inputs[c % len(inputs)] for c in range(predicted.shape[1])], axis=1) if inputs else predicted
        return JointLog(
            name=r.episode.name,
            role=r.episode.role,
            t=t,
            dt=float(np.median(np.diff(t))),
            cutoff=float("inf"),
            q=predicted,
            dq=rate,
            ddq=np.gradient(rate, t, axis=0),
            rigid=pushed,
            measured=r.measured,
            residual=residual,
            raw=pushed + residual,
            slow=SLOW * np.quantile(np.abs(rate), 0.95, axis=0) + 1e-9,
            trim=0,
        )

    def _column(self, r: Recording, e: Effect) -> np.ndarray:
        key = (r.episode.name, *e.key)
        if key not in self._columns:
            self._columns[key] = self._sim.tangent(r, self.values, e)
        return self._columns[key]

    def _block(self, e: Effect) -> Block:
        def build(log: JointLog) -> np.ndarray:
            return self._column(self._recordings[log.name.rstrip("~")], e)

        return Block(
            name=e.name,
            target=e.target,
            recalibration=e.recalibration,
            channels=tuple(range(len(self._sim.system.channels))),
            parameters=e.parameters,
            contains=e.contains,
            build=build,
        )

    def _acts(self, block: Block) -> bool:
        """Whether an effect changes any prediction here, as more than rounding would."""
        unit = np.array([p.typical for p in block.parameters])
        moved = max(float(np.abs(block.build(log) * unit / self._sim.scale[:, None]).max()) for log in self.logs)
        return moved > 1e-9
