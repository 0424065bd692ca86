"""The four steps for records of dressing runs: those of a user's own system, round after round nearer to the answer."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ....sim.record.recorded_stretch import Stretch
from ..errors import GapError
from ..measurement import Episode, MeasurementSet
from ..own.naming import Found, name_own
from ..own.simulation import Recording, recording
from ..own.study import OwnStudy
from .loads import CHANNELS, SEEN, Predictions
from .system import DRAG, DressingSystem, entries

ROUNDS = 8
SLIP = 0.03  # an arm seen so far from where it is seen otherwise, against the model's, is a slip of the tracker [m]
CLOSE = 0.1  # typical sizes by which values may differ from where the world was simulated


class DressingStudy(OwnStudy):
    """Loads on a hand that holds an arm or a sleeve, against the dressing world led through the same motion.

    Args:
        measured: the set.
        alpha: level of the tests.
        cache: folder for what was simulated, or None.
    """

    system: DressingSystem

    def __init__(self, measured: MeasurementSet, alpha: float = 0.05, cache: Path | None = None) -> None:
        stretches: list[Stretch] = []
        for e in measured.episodes:
            if "stretch" not in e.settings:
                raise GapError(f"{e.name}: system dressing takes records of runs, given as `run: FOLDER`")
            stretches.append(e.settings["stretch"])
        self.predictions = Predictions(cache)
        numbered = tuple(_numbered(e, k) for k, e in enumerate(measured.episodes))
        system = DressingSystem(stretches, self.predictions)
        super().__init__(replace(measured, episodes=numbered), alpha, system, "")

    @cached_property
    def _recordings(self) -> tuple[list[Recording], list[Recording]]:
        """To fit, and held out; where the tracker slipped, the arm counts as seen where it is taken to be."""
        groups = (self.measured.fitted, self.measured.heldout)
        fitted, heldout = ([recording(self._without_slips(e), self.system) for e in group] for group in groups)
        return fitted, heldout

    def _without_slips(self, episode: Episode) -> Episode:
        if SEEN[0] not in self.system.channels:
            return episode
        seen = np.stack([episode.columns[c] for c in SEEN], axis=1)
        given = self.predictions.of(episode.settings["stretch"], ())[:, len(CHANNELS) :]
        usual = np.median(seen - given, axis=0)
        slipped = np.linalg.norm(seen - given - usual, axis=1) > SLIP
        mended = np.where(slipped[:, None], given + usual, seen)
        return replace(episode, columns={**episode.columns, **dict(zip(SEEN, mended.T, strict=True))})

    @cached_property
    def _searched(self) -> tuple[Found, str]:
        """The search's result where the world was simulated at the values found.

        Held-out recordings have their say only there: straight on from elsewhere, a right value may leave as much of
        them as none.
        """
        at = dict.fromkeys((p.name for e in self.system.effects for p in e.parameters), 0.0)
        drags, held_to = [0.0] * len(self.measured.episodes), False
        simulated = [p for e in self.system.effects if not e.regressor for p in e.parameters]
        searched = None
        for _ in range(ROUNDS):
            self.system.move_to(at, drags)
            vars(self).pop("sim", None)  # what it keeps was the world elsewhere
            searched = name_own(self.sim), ""
            if held_to:
                searched = self._held_to(searched[0])
            found = searched[0].point.values
            before, drags = drags, self._drags(searched[0])
            still = np.allclose(before, drags, atol=CLOSE * DRAG.typical)
            still = still and all(abs(found[p.name] - at[p.name]) < CLOSE * p.typical for p in simulated)
            if still and held_to:
                break
            if still:
                held_to, drags = True, before
            else:
                at = {**at, **found}
        else:
            self.notes.append(f"The values had not come to rest after {ROUNDS} rounds of simulation.")
            searched = searched if held_to or searched is None else self._held_to(searched[0])
        assert searched is not None
        return searched

    def _drags(self, found: Found) -> list[float]:
        """How far the fingers dragged the arm along, by the recordings' own numbers, in their order [m]."""
        recordings = {int(r.columns["window"][0]): r for r in (*self._recordings[0], *self._recordings[1])}
        own = (self.sim.own(recordings[k], found.point.values) for k in range(len(recordings)))
        return [round(x.get(DRAG.name, 0.0), 5) for x in own]

    def patch(self) -> dict[str, Any]:
        """See `Study.patch`."""
        found = entries(self.found.effects, self.found.point.values)
        return {"system": "dressing", "effects": [e.__dict__ for e in found]}


def _numbered(episode: Episode, k: int) -> Episode:
    """An episode that says in a column which one it is."""
    window = np.full(len(episode.t), float(k))
    return replace(episode, columns={**episode.columns, "window": window})
