"""Keeps every link off the person and off the robot itself: hands slide along, what was planned too near is refused."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...sim.world import SIDES, BaseVelocity, HandTwist, JointTrajectory, Observation, Side
from ...skills.core.reasons import Reason, SkillFailure
from ...skills.geometry.clearance import LinkClearance
from ...skills.geometry.person_zone import PersonZone
from .link_motion import LinkMotion
from .own_links import OwnLinks

APPROACH = 0.5  # share of what is left of a gap that one command may use up: a link slows down as it comes near
SLIDES = 4  # corrections of a twist before it is slowed down as a whole
SLOWER = (0.5, 0.25)  # shares that are tried of a motion that cannot slide
TOLERANCE = 1e-4  # [m] of a gap, for rounding
PLANNED_TOLERANCE = 0.004  # [m] the same for a trajectory, which an arm follows a little beside
CHECKED = 60  # poses of a trajectory that are tested, about


class KeepClear:
    """The gaps between the robot's links and the person, and among those links, before and after each command.

    A link that is too near already, because the person has moved or is seen better, may go anywhere but nearer.

    Args:
        motion: where commands bring the links.
        zone: where the person is.
    """

    def __init__(self, motion: LinkMotion, zone: PersonZone) -> None:
        self._motion, self._zone = motion, zone
        self._own = None if motion.known is None else OwnLinks(motion, motion.known)
        self._clearance = LinkClearance(motion.names, motion.radii)

    def twist(self, command: HandTwist, twist: np.ndarray, seen: Observation, held: Mapping[Side, str]) -> np.ndarray:
        """The part (6,) of a twist (6,) that keeps the arm's links off the person and off the rest of the robot."""
        if self._own is None or not np.any(twist):
            return twist
        rows = self._motion.rows(command.side)
        room, away = self._all_room(self._motion.ends(seen), held, rows)
        least = _least(room)

        def shortfall(tried: np.ndarray) -> np.ndarray:
            after = self._motion.after_twist(seen, command.side, tried, command.duration)
            return least - self._all_room(after, held, rows)[0]

        for start in (twist, np.append(twist[:3], np.zeros(3))):  # where nothing turns, the hand may still slide
            slid = start.copy()
            for _ in range(SLIDES):
                short = shortfall(slid)
                if short.max(initial=-np.inf) <= TOLERANCE:
                    return slid
                worst = np.unravel_index(int(short.argmax()), short.shape)
                slid[:3] += away[worst] * short[worst] / max(command.duration, 1e-6)
            for slower in (share * way for way in (slid, start) for share in SLOWER):  # turning cannot slide
                if shortfall(slower).max() <= TOLERANCE:
                    return slower
        return np.zeros(6)

    def base(self, command: BaseVelocity, seen: Observation, held: Mapping[Side, str]) -> float:
        """Share of the base's velocity that keeps all links off the person."""
        if self._own is None or not np.any(command.velocity):
            return 1.0
        least = _least(self._room(self._motion.ends(seen), held)[0])
        for share in (1.0, *SLOWER):
            after = self._motion.after_base(seen, share * np.asarray(command.velocity, float), command.duration)
            if (least - self._room(after, held)[0]).max(initial=-np.inf) <= TOLERANCE:
                return share
        return 0.0

    def trajectory(self, command: JointTrajectory, seen: Observation, held: Mapping[Side, str]) -> None:
        """Refuse a trajectory that brings a link too near.

        Raises:
            SkillFailure: MOTION_BLOCKED, which names the link and the part of the person, or both links.
        """
        if self._own is None:
            return
        sides: list[Side] = [side for side in SIDES if any(joint.startswith(side) for joint in command.joints)]
        if not sides:
            return
        _, ends = self._motion.along(command, seen)
        rows = np.any([self._motion.rows(side) for side in sides], axis=0)[:, None]
        least = np.where(rows, np.minimum(self._room(ends[0], held)[0], 0.0) - PLANNED_TOLERANCE, -np.inf)
        for after in (*ends[:: max(1, len(ends) // CHECKED)], ends[-1]):
            if self._clearance.less_left(after, self._zone, held, least):
                short = least - self._room(after, held)[0]
                link, part = np.unravel_index(int(short.argmax()), short.shape)
                name = self._motion.names[link].rstrip("_123456789").replace("_", " ")
                raise SkillFailure(
                    Reason.MOTION_BLOCKED, f"the {name} would come too near to the person's {self._zone.names[part]}"
                )
        self._own.judge(command, seen)

    def _all_room(self, ends: np.ndarray, held: Mapping[Side, str], rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What is left (k, m) of the gaps of the links `rows` (r,) to person and robot, and directions (k, m, 3)."""
        assert self._own is not None
        pairs = zip(self._clearance.room(ends, self._zone, held, rows), self._own.room(ends, rows), strict=True)
        room, away = (np.concatenate(pair, axis=1) for pair in pairs)
        return room, away

    def _room(self, ends: np.ndarray, held: Mapping[Side, str]) -> tuple[np.ndarray, np.ndarray]:
        return self._clearance.room(ends, self._zone, held)


def _least(room: np.ndarray) -> np.ndarray:
    """What must be left of each gap after a command that begins with `room` [m]."""
    return np.where(room > 0.0, (1.0 - APPROACH) * room, room)
