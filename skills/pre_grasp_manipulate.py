"""Stage B: isolate one corner of the neckline with open fingers, then grasp it."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import replace
from itertools import product

import numpy as np

from ..perception.errors import PerceptionFailure
from ..perception.estimates import PreGrasp
from ..perception.image.cloud import unit
from ..sim.robot.kinematics import planar_pose
from ..sim.world import SIDES, Side
from .control.hands import cloth_load, hand_now, move_hands, open_gripper
from .control.hold_up import HOLD_UP, present
from .control.pinch import back_off, grasp_poses, pinch, reach_in
from .core.ports import Input, Output
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .motion.errors import MotionError, Unreachable
from .view_around import Attempts, Views

ATTEMPTS = 3  # corners tried from the same views
AGAIN = (Reason.GRASP_MISSED, Reason.MULTI_LAYER)
DEPTH = 0.014  # of the fingertips beyond the corner: what lies behind it is not to be taken too [m]
TUG = 0.07  # how far the hand draws what it took up and towards itself, to feel its weight [m]
TURNS = (0, 20, 40, 60, -20)  # of the approach, from the camera's towards the right hand's own side [degrees]
PITCHES = (25, 50, 0)  # of the approach, downwards, as the camera looks down too [degrees]
SETTLE = 0.6  # how long the gown swings after it was turned [s]
UP = np.array((0.0, 0.0, 1.0))
_SAME = 0.07  # a corner found again this near to where it was expected is the same one [m]


class PreGraspManipulate(Skill):
    """Chooses among move-left-grasp, direct-grasp and move-right-grasp from all views, and carries it out.

    Inputs: `views` of the gown hanging from one hand; `nearest` and `farthest`, where corners may be, from that hand
    [m]; `sure`, the least confidence in one; `opening` of the other hand's fingers [m]; `force`, squeezing [N];
    `weight`, the least load that a tug must bring [N].  Outputs: `holder`, the hand that took the corner; `former`,
    the one that held the gown so far; `corner`, what was chosen.  A corner that could not be had is left out next time.
    """

    views = Input(Views)
    nearest = Input(float, default=0.12)
    farthest = Input(float, default=2.0)
    sure = Input(float, default=0.2)
    opening = Input(float, default=0.05)
    force = Input(float, default=30.0)
    weight = Input(float, default=0.15)
    holder = Output(Side)
    former = Output(Side)
    corner = Output(PreGrasp)
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
        for _ in range(ATTEMPTS):
            try:
                yield from self._attempt()
                return
            except (SkillFailure, MotionError) as miss:
                if isinstance(miss, SkillFailure) and miss.reason not in AGAIN:
                    raise failed or miss from miss
                failed = miss
            except PerceptionFailure as nothing:  # no corner is left: what went wrong before says more
                raise failed or nothing from nothing
        assert failed is not None
        raise failed

    def _attempt(self) -> Iterator[None]:
        """Choose, turn the gown back to the chosen view, look again, go in, sweep, count layers, grasp, tug."""
        views = self.views
        hand: Side = SIDES[1 - SIDES.index(views.side)]
        attempts = self.context.memory.of(Attempts, Attempts, name=views.side)
        chosen = self.context.senses.pre_grasp(
            views.frames,
            poses_hand_in_map=views.poses_hand_in_map,
            exclude=attempts.given_up(),
            distance=(self.nearest, self.farthest),
        )
        if chosen.confidence < self.sure:
            raise SkillFailure(Reason.NOTHING_SEEN, f"the best corner has a confidence of {chosen.confidence:.2f}")
        held = views.poses_hand_in_map[chosen.view]
        place = held[:3, :3].T @ (chosen.corner_in_map - held[:3, 3])
        self.note(f"{chosen.primitive.replace('_', ' ')} in view {chosen.view + 1}, confidence {chosen.confidence:.2f}")
        yield from present(self, views.side, self._angle(held))
        yield from self.wait(SETTLE)
        try:
            chosen = self._towards(hand, views, self._look_again(chosen, views.side))
            yield from reach_in(
                self,
                hand,
                chosen.position_in_map,
                chosen.approach_in_map,
                unit(np.cross(chosen.approach_in_map, UP)),
                opening=self.opening,
                depth=DEPTH,
            )
            yield from self._take(hand, views, chosen)
        except (SkillFailure, MotionError) as miss:
            missed = isinstance(miss, SkillFailure) and miss.reason == Reason.GRASP_MISSED
            attempts.places += [place] if missed else [place, place]
            yield from open_gripper(self, hand)
            yield from back_off(self, hand)
            raise
        for side in SIDES:  # the gown hangs differently from now on
            self.context.memory.of(Attempts, Attempts, name=side).forget()
        self.holder, self.former, self.corner = hand, views.side, chosen

    def _angle(self, pose: np.ndarray) -> float:
        """By how much a presented hand is turned at a pose (4, 4) in the map [rad]."""
        angle = np.arctan2(-pose[0, 1], pose[1, 1]) - self.world.observe().pose_base_in_map[2]
        return float(np.clip((angle + np.pi) % (2 * np.pi) - np.pi, -HOLD_UP.max_turn, HOLD_UP.max_turn))

    def _towards(self, hand: Side, views: Views, chosen: PreGrasp) -> PreGrasp:
        """The same with the approach turned to where the hand reaches in between the fewest sheets.

        Raises:
            Unreachable: from everywhere.
        """
        failure: Unreachable | None = None
        best: tuple[int, PreGrasp] | None = None
        for pitch, turn in product(PITCHES, TURNS):
            rotation = planar_pose(np.array((0.0, 0.0, np.deg2rad(turn if hand == "right" else -turn))))[:3, :3]
            sweep, level = rotation @ chosen.sweep_in_map, rotation @ chosen.approach_in_map
            approach = np.cos(np.deg2rad(pitch)) * level - np.sin(np.deg2rad(pitch)) * UP
            turned = replace(
                chosen, approach_in_map=approach, sweep_in_map=sweep, position_in_map=chosen.corner_in_map - sweep
            )
            across = unit(np.cross(approach, UP))
            try:
                _, inside = grasp_poses(self, hand, turned.position_in_map, approach, across, sweep=sweep, depth=DEPTH)
            except Unreachable as stop:
                failure = stop
                continue
            inside[:3, 3] += sweep
            sheets = self._sheets(hand, views, inside)
            if sheets == 1:
                return turned
            if best is None or abs(sheets - 1) < best[0]:
                best = abs(sheets - 1), turned
        if best is None:
            assert failure is not None
            raise failure
        return best[1]

    def _look_again(self, chosen: PreGrasp, side: Side) -> PreGrasp:
        """The same corner in a fresh frame, or `chosen` where it does not show."""
        try:
            now = self.context.senses.pre_grasp(
                (self.world.look("head"),),
                poses_hand_in_map=(hand_now(self, side),),
                distance=(self.nearest, self.farthest),
            )
        except PerceptionFailure:
            return chosen
        return now if np.linalg.norm(now.corner_in_map - chosen.corner_in_map) < _SAME else chosen

    def _take(self, hand: Side, views: Views, chosen: PreGrasp) -> Iterator[None]:
        if np.any(chosen.sweep_in_map):
            pose = hand_now(self, hand)
            pose[:3, 3] += chosen.sweep_in_map
            yield from move_hands(self, {hand: pose}, speed=0.1)
        sheets = self._sheets(hand, views, hand_now(self, hand))
        if sheets > 1:
            raise SkillFailure(Reason.MULTI_LAYER, f"{sheets} sheets between the {hand} fingers")
        before = yield from self._weigh(hand)
        yield from pinch(self, hand, force=self.force)
        pose = hand_now(self, hand)
        pose[:3, 3] += TUG * unit(UP - pose[:3, 2])
        yield from move_hands(self, {hand: pose}, speed=0.2, free="approach")
        felt = (yield from self._weigh(hand)) - before
        if felt < self.weight:
            raise SkillFailure(Reason.GRASP_MISSED, f"the tug was answered by {felt:.2f} N")

    def _weigh(self, hand: Side) -> Generator[None, None, float]:
        """Mean load on a hand over a moment [N]."""
        samples = []
        for _ in range(5):
            samples.append(cloth_load(self, hand))
            yield
        return float(np.linalg.norm(np.mean(samples, axis=0)))

    def _sheets(self, hand: Side, views: Views, pose: np.ndarray) -> int:
        """How many sheets the fingers would take at a pose (4, 4), by everything that was seen of the gown."""
        poses = (*views.poses_hand_in_map[1:], hand_now(self, views.side))
        return self.context.senses.layers(
            (*views.frames[1:], self.world.look("head")),
            side=hand,
            pose_hand_in_map=pose,
            poses_cloth_in_map=poses,
            opening=self.opening,
        ).layers
