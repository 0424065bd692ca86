"""Stage D: take the collar near a shoulder, lift it a little, and draw it up to the neck."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..perception.cloud import unit
from ..perception.estimates import GraspPoint
from ..sim.world import SIDES, HandTwist, Side
from .arm_path import UP
from .bedside import outwards
from .context import Context
from .hands import cloth_load, hand_now, move_hands, open_gripper
from .pinch import pinch, reach_in
from .ports import Input, Output
from .pull_law import PullLaw
from .reasons import Reason, SkillFailure
from .retreat import withdraw
from .scripted_person import offer_person
from .skill import Skill
from .tracking import watch_arm

LIFT = 0.05  # the collar is lifted this far off the body before it is drawn [m]
DRAW = 0.07  # and then drawn at most this far [m]
SPEED = 0.08  # [m/s]
TAUT = 4.0  # a collar that pulls this hard is where it can be [N]
_NECK = np.array((0.12, -0.03, 0.10))  # goal for the collar from a shoulder: inwards, headward, above [m]
_STEEPEST = np.deg2rad(35.0)  # the hand comes from above, at most this far off the vertical


class Spread(Skill):
    """Grasps the neck binding near one shoulder and draws it to the neck, so that the gown lies straight.

    Inputs: `side` of the person; `hand` that does it.  Output: `grasp`, the place it took.
    It ends with the hand open and drawn back, whether it succeeds or misses.
    """

    side = Input(Side)
    hand = Input(Side)
    grasp = Output(GraspPoint)
    reasons = (Reason.NOTHING_SEEN, Reason.ARM_LOST, Reason.UNREACHABLE, Reason.MOTION_BLOCKED, Reason.GRASP_MISSED,
               Reason.FORCE_LIMIT, Reason.COMMAND_LOST)

    def steps(self) -> Iterator[None]:
        """Look, reach in, pinch, lift, draw, let go."""
        self.note(f"looks for the collar near the {self.side} shoulder")
        shoulder = watch_arm(self, self.side).points_in_map[0]
        point = self.context.perceive("collar_near_shoulder", self.world.look("head"), side=self.side,
                                      shoulder_in_map=shoulder)
        approach = _from_above(point.approach_in_map, outwards(self.side))
        yield from reach_in(self, self.hand, point.position_in_map, approach, point.closing_in_map)
        try:
            yield from pinch(self, self.hand)
        except SkillFailure as miss:
            if miss.reason == Reason.GRASP_MISSED:
                yield from open_gripper(self, self.hand)
                yield from withdraw(self, [self.hand], 0.12)
            raise
        self.note(f"draws the collar to the neck from the {self.side}")
        lifted = hand_now(self, self.hand)
        lifted[:3, 3] += LIFT * UP
        yield from move_hands(self, {self.hand: lifted}, speed=SPEED, way="either")
        yield from self._draw(shoulder)
        yield from open_gripper(self, self.hand)
        yield from withdraw(self, [self.hand], 0.12)
        self.grasp = point

    def _draw(self, shoulder: np.ndarray) -> Iterator[None]:
        """Pull towards the neck until there, far enough, or taut."""
        n, law = SIDES.index(self.hand), PullLaw()
        goal = shoulder + _NECK * np.where(np.arange(3) == 0, -outwards(self.side)[0], 1.0)
        start = hand_now(self, self.hand)[:3, 3]
        end = self.now() + 2.0 * DRAW / SPEED
        while self.now() < end:
            here = self.world.observe().pose_hand_in_map[n, :3, 3]
            load = cloth_load(self, self.hand)
            way = goal - here
            if np.linalg.norm(way) < 0.01 or np.linalg.norm(here - start) > DRAW or np.linalg.norm(load) > TAUT:
                return
            speed = min(SPEED, 2.0 * float(np.linalg.norm(way))) * law.ease(load)
            self.world.send(HandTwist(side=self.hand, twist_in_map=np.append(speed * unit(way), np.zeros(3))))
            yield

    @classmethod
    def example(cls, context: Context) -> Skill:
        """For the law tests."""
        offer_person(context)
        return cls("spread", context, side="left", hand="left")


def _from_above(approach: np.ndarray, outward: np.ndarray) -> np.ndarray:
    """The allowed approach nearest to one that is square to the cloth: steep, and from the robot's side of the bed."""
    lean = approach + UP * max(-float(approach @ UP), 0.0)  # the horizontal part
    if lean @ outward > 0.0:
        lean = lean - (lean @ outward) * outward
    angle = min(float(np.arctan2(np.linalg.norm(lean), max(-float(approach[2]), 1e-6))), _STEEPEST)
    return -np.cos(angle) * UP + np.sin(angle) * (unit(lean) if np.linalg.norm(lean) > 1e-6 else np.zeros(3))
