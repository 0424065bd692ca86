"""Isolate one corner of the neckline with open fingers, then grasp it."""

from __future__ import annotations

import math
from collections.abc import Generator, Iterator
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import PreGrasp
from ..perception.image.cloud import unit
from ..sim.mechanics.planar import planar_pose
from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, Side
from .control.fingers import open_gripper
from .control.hands import cloth_load, hand_now, move_hands
from .control.hold_up import HOLD_UP, present
from .control.pinch import back_off, grasp_poses, pinch, reach_in
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .core.tries import Tries
from .geometry.arm_path import UP
from .motion.errors import MotionError, Unreachable
from .view_around import Views

TRY_NEXT = (Reason.GRASP_MISSED, Reason.MULTI_LAYER)  # after these, the next best corner is tried


@dataclass(frozen=True, kw_only=True)
class PreGraspTuning(Quantities):
    """Numbers of `PreGraspManipulate`."""

    attempts: int = quantity(3, "1", "corners tried from the same views", "choice: by then the gown has been moved")
    depth: float = quantity(
        0.014, "m", "of the fingertips beyond the corner", "choice: what hangs behind the corner is not to be taken too"
    )
    approach_angles: tuple[float, ...] = quantity(
        tuple(float(np.deg2rad(angle)) for angle in (0.0, 20.0, 40.0, 60.0, -20.0)),
        "rad",
        "of the approach, from the camera's direction towards the hand's own side, in the order of trying",
        "choice: a hand reaches in from its own side with most ease",
    )
    approach_pitches: tuple[float, ...] = quantity(
        tuple(float(np.deg2rad(angle)) for angle in (25.0, 50.0, 0.0)),
        "rad",
        "of the approach, downwards, in the order of trying",
        "choice: the camera looks down too",
    )
    settle_time: float = quantity(0.6, "s", "after the gown was turned", "choice: the gown swings out")
    same_corner: float = quantity(
        0.07, "m", "distance within which a corner that is found again is the same", "choice: how far the gown sways"
    )
    same_place: float = quantity(
        0.05,
        "m",
        "distance, in the frame of the holding hand, within which two grasps went for the same place",
        "choice: less than corners lie apart",
    )
    sweep_speed: float = quantity(0.1, "m/s", "of the hand that pushes cloth aside", "choice: the cloth gives way")
    tug_distance: float = quantity(
        0.07, "m", "by which the hand draws what it took up and towards itself", "choice: enough to feel its weight"
    )
    tug_speed: float = quantity(0.2, "m/s", "of the hand while it tugs", "choice: slow, so that cloth is not flung")
    load_samples: int = quantity(
        5, "1", "readings of the force sensor whose mean counts", "choice: a third of a second"
    )


@dataclass
class FailedGrasps:
    """Where grasps failed since a hand last took the gown.

    Attributes:
        places: (3,) in the frame of the holding hand [m].
    """

    places: list[np.ndarray] = field(default_factory=list)

    def given_up(self, radius: float) -> tuple[np.ndarray, ...]:
        """The places (3,) at which two grasps failed; places within `radius` [m] are the same."""
        return tuple(
            a for n, a in enumerate(self.places) if any(np.linalg.norm(a - b) < radius for b in self.places[:n])
        )

    def forget(self) -> None:
        """Start anew, because the gown hangs differently."""
        self.places.clear()


class PreGraspManipulate(Skill):
    """Chooses among move-left-grasp, direct-grasp and move-right-grasp from all views, and carries it out.

    Where the grasp fails, the next best corner from the same views is tried.  A corner that could not be taken is left
    out next time.  It fails where no corner shows or none of those tried could be taken.
    """

    views = Input(Views, doc="of the gown that hangs from one hand")
    min_distance = Input(float, unit="m", doc="least distance of a corner from that hand", default=0.12)
    max_distance = Input(float, unit="m", doc="greatest distance of a corner from that hand", default=2.0)
    min_confidence = Input(float, unit="1", doc="least confidence of a corner to go for", default=0.2)
    opening = Input(float, unit="m", doc="between the fingertips of the other hand on the way in", default=0.05)
    force = Input(float, unit="N", doc="of the grip at most", default=30.0)
    min_load = Input(float, unit="N", doc="least load that a tug must bring", default=0.15)
    tuning = Input(PreGraspTuning, default=PreGraspTuning(), doc="numbers of this skill")
    holder = Output(Side, doc="the hand that took the corner")
    former = Output(Side, doc="the hand that held the gown so far")
    corner = Output(PreGrasp, unit="m, map", doc="the grasp that was chosen")
    reasons = (
        Reason.NOTHING_SEEN,
        Reason.MULTI_LAYER,
        Reason.GRASP_MISSED,
        Reason.UNREACHABLE,
        Reason.MOTION_BLOCKED,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Try the best corner, then the next best ones, from the same views."""
        failed: Exception | None = None
        for _ in range(self.tuning.attempts):
            try:
                yield from self._attempt()
                return
            except (SkillFailure, MotionError) as miss:
                if isinstance(miss, SkillFailure) and miss.reason not in TRY_NEXT:
                    raise failed or miss from miss
                failed = miss
            except PerceptionFailure as nothing:  # no corner is left: what went wrong before says more
                raise failed or nothing from nothing
        assert failed is not None
        raise failed

    def _attempt(self) -> Iterator[None]:
        """Choose, turn the gown back to the chosen view, look again, go in, sweep, count layers, grasp, tug."""
        views, tuning = self.views, self.tuning
        hand: Side = SIDES[1 - SIDES.index(views.hand)]
        failed = self.context.memory.of(FailedGrasps, FailedGrasps, name=views.hand)
        chosen = self.context.senses.pre_grasp(
            views.frames,
            poses_hand_in_map=views.poses_hand_in_map,
            exclude=failed.given_up(tuning.same_place),
            distance=(self.min_distance, self.max_distance),
        )
        if chosen.confidence < self.min_confidence:
            raise SkillFailure(Reason.NOTHING_SEEN, f"the best corner has a confidence of {chosen.confidence:.2f}")
        held = views.poses_hand_in_map[chosen.view]
        place = held[:3, :3].T @ (chosen.corner_in_map - held[:3, 3])
        self.note(f"{chosen.primitive.replace('_', ' ')} in view {chosen.view + 1}, confidence {chosen.confidence:.2f}")
        yield from present(self, views.hand, self._angle(held))
        yield from self.wait(tuning.settle_time)
        try:
            chosen = self._towards(hand, views, self._look_again(chosen, views.hand))
            yield from reach_in(
                self,
                hand,
                chosen.position_in_map,
                chosen.approach_in_map,
                unit(np.cross(chosen.approach_in_map, UP)),
                opening=self.opening,
                depth=tuning.depth,
            )
            yield from self._take(hand, views, chosen)
        except (SkillFailure, MotionError) as miss:
            missed = isinstance(miss, SkillFailure) and miss.reason in TRY_NEXT
            failed.places += [place] if missed else [place, place]
            yield from open_gripper(self, hand)
            yield from back_off(self, hand)
            raise
        for side in SIDES:  # the gown hangs differently from now on
            self.context.memory.of(FailedGrasps, FailedGrasps, name=side).forget()
        self.holder, self.former, self.corner = hand, views.hand, chosen

    def _angle(self, pose: np.ndarray) -> float:
        """The turn about the vertical of a presented hand at a pose (4, 4) in the map [rad]."""
        angle = math.atan2(-pose[0, 1], pose[1, 1]) - self.world.observe().pose_base_in_map[2]
        return float(np.clip((angle + np.pi) % (2 * np.pi) - np.pi, -HOLD_UP.max_turn, HOLD_UP.max_turn))

    def _towards(self, hand: Side, views: Views, chosen: PreGrasp) -> PreGrasp:
        """The same grasp with an approach by which the fingers take one sheet, or as nearly one as possible.

        Raises:
            Unreachable: by every approach.
        """
        tuning, tries = self.tuning, Tries(Unreachable)
        best: tuple[int, PreGrasp] | None = None
        for pitch, turn in product(tuning.approach_pitches, tuning.approach_angles):
            rotation = planar_pose(np.array((0.0, 0.0, turn if hand == "right" else -turn)))[:3, :3]
            sweep, level = rotation @ chosen.sweep_in_map, rotation @ chosen.approach_in_map
            approach = math.cos(pitch) * level - math.sin(pitch) * UP
            turned = replace(
                chosen, approach_in_map=approach, sweep_in_map=sweep, position_in_map=chosen.corner_in_map - sweep
            )
            across = unit(np.cross(approach, UP))
            with tries:
                _, inside = grasp_poses(
                    self, hand, turned.position_in_map, approach, across, sweep=sweep, depth=tuning.depth
                )
                inside[:3, 3] += sweep
                sheets = self._sheets(hand, views, inside)
                if sheets == 1:
                    return turned
                if best is None or abs(sheets - 1) < best[0]:
                    best = abs(sheets - 1), turned
        if best is None:
            raise tries.last
        return best[1]

    def _look_again(self, chosen: PreGrasp, holding: Side) -> PreGrasp:
        """The same corner in a fresh frame, or `chosen` where it does not show."""
        try:
            now = self.context.senses.pre_grasp(
                (self.world.look("head"),),
                poses_hand_in_map=(hand_now(self, holding),),
                distance=(self.min_distance, self.max_distance),
            )
        except PerceptionFailure:
            return chosen
        moved = np.linalg.norm(now.corner_in_map - chosen.corner_in_map)
        return now if moved < self.tuning.same_corner else chosen

    def _take(self, hand: Side, views: Views, chosen: PreGrasp) -> Iterator[None]:
        """Sweep other cloth aside, close the fingers on one sheet, and tug.

        Raises:
            SkillFailure: MULTI_LAYER, GRASP_MISSED.
        """
        tuning = self.tuning
        if np.any(chosen.sweep_in_map):
            pose = hand_now(self, hand)
            pose[:3, 3] += chosen.sweep_in_map
            yield from move_hands(self, {hand: pose}, speed=tuning.sweep_speed)
        sheets = self._sheets(hand, views, hand_now(self, hand))
        if sheets > 1:
            raise SkillFailure(Reason.MULTI_LAYER, f"{sheets} sheets between the {hand} fingers")
        before = yield from self._weigh(hand)
        yield from pinch(self, hand, force=self.force)
        pose = hand_now(self, hand)
        pose[:3, 3] += tuning.tug_distance * unit(UP - pose[:3, 2])
        yield from move_hands(self, {hand: pose}, speed=tuning.tug_speed, free="approach")
        felt = (yield from self._weigh(hand)) - before
        if felt < self.min_load:
            raise SkillFailure(Reason.GRASP_MISSED, f"the tug was answered by {felt:.2f} N")

    def _weigh(self, hand: Side) -> Generator[None, None, float]:
        """Mean load on a hand over a moment [N]."""
        samples = []
        for _ in range(self.tuning.load_samples):
            samples.append(cloth_load(self, hand))
            yield
        return float(np.linalg.norm(np.mean(samples, axis=0)))

    def _sheets(self, hand: Side, views: Views, pose: np.ndarray) -> int:
        """How many sheets the fingers would take at a pose (4, 4), by everything that was seen of the gown."""
        poses = (*views.poses_hand_in_map[1:], hand_now(self, views.hand))
        return self.context.senses.layers(
            (*views.frames[1:], self.world.look("head")),
            side=hand,
            pose_hand_in_map=pose,
            poses_cloth_in_map=poses,
            opening=self.opening,
        ).layers
