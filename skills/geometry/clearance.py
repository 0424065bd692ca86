"""How near each link of the robot may come to each part of the person."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.segments import any_nearer
from ...sim.world import Side
from .person_zone import HEAD, PersonZone


@dataclass(frozen=True, kw_only=True)
class ClearanceTuning(Quantities):
    """Least gaps between a link and a part of the person as it is tracked; below 0 they may touch.

    Fingers work at cloth that lies on the person, and close round arms; nothing else comes to the skin, and nothing at
    all to head and neck.
    """

    fingers_head: float = quantity(0.02, "m", "of fingers to head and neck", "choice: the head is seen to 1 cm")
    fingers_trunk: float = quantity(
        -0.003, "m", "of fingers to trunk and legs", "choice: cloth lies there, and 1 mm into the skin are 20 N"
    )
    fingers_arm: float = quantity(-0.02, "m", "of fingers to arms", "choice: an arm is tracked to 1 or 2 cm")
    palm_head: float = quantity(0.02, "m", "of palm and wrist to head and neck", "choice: the head is seen to 1 cm")
    palm_trunk: float = quantity(0.01, "m", "of palm and wrist to trunk and legs", "choice: the trunk is seen to 1 cm")
    palm_arm: float = quantity(
        0.0, "m", "of palm and wrist to arms", "design: fingers of 6 cm leave it 1.5 cm over an arm that they take"
    )
    link_head: float = quantity(0.03, "m", "of other links to head and neck", "choice: they have no business there")
    link_trunk: float = quantity(0.02, "m", "of other links to trunk and legs", "choice: they have no business there")
    link_arm: float = quantity(0.005, "m", "of other links to arms", "choice: an arm is tracked to 1 or 2 cm")
    lifted_arm: float = quantity(
        0.01,
        "m",
        "of the robot's other arm to an arm that is held up, where a way is searched",
        "measured: a finger that might come 2 cm nearer than that met forearm and hand with 35 and 27 N, which was "
        "taken for a motion of the person (183, 179); a held arm is tracked to 1 cm",
    )
    planned: float = quantity(
        0.005, "m", "more than that where a way is searched", "choice: a smooth motion cuts the corners of its path"
    )


CLEARANCE = ClearanceTuning()
MAY_TOUCH = -10.0  # [m] a least gap that no link can miss; finite, as differences are taken


class LinkClearance:
    """What each link of one robot has to keep from each part of the person.

    Args:
        names: (r,) of the links' capsules (`sim/mechanics/capsules.py`).
        radii: (r,) of them [m].
        tuning: the least gaps.
    """

    def __init__(self, names: tuple[str, ...], radii: np.ndarray, *, tuning: ClearanceTuning = CLEARANCE) -> None:
        self.names, self.radii, self.tuning = names, radii, tuning
        self._kinds = [link_kind(name) for name in names]
        self._asked: tuple[tuple[str, ...], dict[Side, str]] = ((), {})  # what `_gaps` was made for
        self._gaps = self.least_gaps(*self._asked)

    def room(
        self, ends_in_map: np.ndarray, zone: PersonZone, held: Mapping[Side, str], rows: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """What is left of each gap: below 0 a link is too near.

        Args:
            ends_in_map: (r, 2, 3) of the links' axes [m].
            zone: where the person is.
            held: hand -> the arm that it holds, which its fingers and palm may touch.
            rows: (r,) bool, of the links that are asked for; all by default.

        Returns:
            (r, m) room [m] and (r, m, 3) directions from the person to the link, of those links.
        """
        if rows is None:
            gaps, away = zone.gaps(ends_in_map, self.radii)
            return gaps - self._least(zone, held), away
        gaps, away = zone.gaps(ends_in_map[rows], self.radii[rows])
        return gaps - self._least(zone, held)[rows], away

    def less_left(self, ends_in_map: np.ndarray, zone: PersonZone, held: Mapping[Side, str], room: np.ndarray) -> bool:
        """Whether less is left of any gap than `room` (r, m) [m]; the other arguments are those of `room()`."""
        return any_nearer(ends_in_map, self.radii, zone.ends, zone.radii, self._least(zone, held) + room)

    def _least(self, zone: PersonZone, held: Mapping[Side, str]) -> np.ndarray:
        """Least gaps (r, m) [m], kept as long as nothing is held otherwise."""
        if (asked := (zone.names, dict(held))) != self._asked:
            self._asked, self._gaps = asked, self.least_gaps(*asked)
        return self._gaps

    def least_gaps(self, parts: tuple[str, ...], held: Mapping[Side, str], *, planned: bool = False) -> np.ndarray:
        """Least gaps (r, m) [m].

        Args:
            parts: (m,) of the person that capsules belong to.
            held: hand -> the arm that it holds, which its fingers and palm may touch.
            planned: a way is searched, and may lead round an arm that is held up; a sleeve is pulled along it closer.
        """
        tuning = self.tuning
        table = {
            "fingers": (tuning.fingers_head, tuning.fingers_trunk, tuning.fingers_arm),
            "palm": (tuning.palm_head, tuning.palm_trunk, tuning.palm_arm),
            "link": (tuning.link_head, tuning.link_trunk, tuning.link_arm),
        }
        columns = [0 if part == HEAD else 2 if part.endswith("arm") else 1 for part in parts]
        least = np.array([[table[kind][column] for column in columns] for kind in self._kinds]).reshape(
            len(self.names), len(parts)
        )
        for side, arm in held.items():
            column = [part == arm for part in parts]
            for row, name in enumerate(self.names):
                if name.startswith(side) and self._kinds[row] != "link":
                    least[row, column] = MAY_TOUCH
                elif planned and not name.startswith(side):
                    least[row, column] = np.maximum(least[row, column], tuning.lifted_arm)
        return least


def link_kind(name: str) -> str:
    """Of a link's capsule by its name: `fingers`, `palm` (the last of the wrist with it) or `link`."""
    if "finger" in name:
        return "fingers"
    return "palm" if "palm" in name or "wrist_2" in name else "link"
