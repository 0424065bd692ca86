"""How far a sleeve comes up an arm that falls: a task of its own for trials, and what its records say.

    caretree run benchmarks/limp_arm.py --stage limp --seed 101 --world-kind easy+falling_arms --out DIR
    caretree run benchmarks/limp_arm.py --stage wide --from DIR@122 --world-kind easy+falling_arms --out WIDE
    python benchmarks/limp_arm.py DIR WIDE ...

Nobody lifts such an arm by its elbow within 30 N.  It is slid out straight until its hand lies beyond the edge of the
bed, where nothing pins what is drawn over it; the hand of the robot that is nearer to the head draws the sleeve up to
the elbow, the other one then raises the wrist, which is bare beyond the cuff, and the sleeve is drawn on past the
elbow.  Nothing swaps hands, and the strap is never let go of.  The stage `wide` goes on from there: facing the head of
the bed, the robot swings the arm out by its wrist until it lies across the edge, and holds it so while the other hand
draws the sleeve on.  What it came to: docs/dressing-findings.md.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from caretree.perception.estimates import ArmPosture
from caretree.perception.person.skin import skin_on_bed
from caretree.sim.world import SIDES, BaseVelocity, HandTwist, Side
from caretree.skills.belief.person_tracking import careful, swung_to, watch_arm
from caretree.skills.control.arm_grip import lost_arm, over_arm, top_down_reachable
from caretree.skills.control.fingers import open_gripper
from caretree.skills.control.hands import hand_now, move_hands
from caretree.skills.control.lowering import LoweringTuning
from caretree.skills.control.take_arm import TakeArmTuning, close_around
from caretree.skills.core.context import Context
from caretree.skills.core.ports import Input
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.core.scope import Scope
from caretree.skills.core.skill import Skill
from caretree.skills.geometry.arm_path import UP, ArmPath
from caretree.skills.geometry.hold import Hold
from caretree.skills.geometry.stances import LIFTING, PULLING, STANCES, outwards
from caretree.skills.grasp_sleeve import GraspSleeve
from caretree.skills.lift_arm import LiftArm, LiftArmTuning, LiftGoal
from caretree.skills.look_at_person import LookAtPerson
from caretree.skills.look_for_sleeve import LookForSleeve
from caretree.skills.motion.drive import PathFollower
from caretree.skills.navigate import Navigate
from caretree.skills.present_sleeve import PresentSleeve
from caretree.skills.pull_along_arm import PullAlongArm
from caretree.skills.release_arm import ReleaseArm, ReleaseArmTuning
from caretree.skills.retreat import Retreat
from caretree.trees.nodes.composers import fallback, sequence
from caretree.trees.nodes.decorators import FailSafe, Stage, timed_stage
from caretree.trees.run.stages import TaskStage
from caretree.trees.tasks.dressing import senses as senses
from caretree.trees.tasks.dressing.arm import arm_in_view, back_off
from caretree.trees.tasks.dressing.safe import make_safe
from py_trees.behaviour import Behaviour

SIDE: Side = "right"
GENTLE = TakeArmTuning(closing_speed=0.03)
SLIDE = LiftArmTuning(take=GENTLE, goal=LiftGoal(grip_coordinate=1.8, pitch=np.deg2rad(5.0), spread=0.6))
RAISE = LiftArmTuning(take=GENTLE, goal=LiftGoal(grip_coordinate=2.4, pitch=np.deg2rad(8.0), spread=0.3))
SWING = LiftArmTuning(take=GENTLE, duration=9.0, goal=LiftGoal(grip_coordinate=2.3, pitch=np.deg2rad(4.0), spread=1.4))
OVER_THE_EDGE = ReleaseArmTuning(lowering=LoweringTuning(edge=-0.4))
LIES_WIDE = ReleaseArmTuning(lowering=LoweringTuning(edge=-0.6))
BELOW = ((0.77, 0.47), (0.84, 0.08))  # x and y of the base that swings a right arm out, at first and in the end [m]
ALONGSIDE = 0.04  # of the base that comes along meanwhile [m/s]
ARM_STAND = (1.05, -0.30)
STRAP_STANDS = ((1.1, 0.6), (1.1, 0.45), (1.2, 0.5))  # x and y of the base for a right arm, tried in turn [m]
WRIST_STAND = (1.15, -0.15)
WRIST_RADIUS, NEAR, ALONG = 0.03, 0.08, 0.03  # [m]; the last two bound the skin that is a wrist's ...
LEAST = 30  # ... of which at least so many points show


class LiftWrist(LiftArm):
    """Looks at the wrist with the hand's own camera: robot and gown hide it from the head's by then."""

    def look_again(self) -> ArmPosture:
        """The arm swung to where its wrist shows; where little skin shows, as it was taken to be."""
        posture, grip = watch_arm(self, self.side, period=0.0), self.tuning.goal.grip_coordinate
        path = ArmPath.of(posture)
        place, along = path.point(grip), path.direction(grip)
        points, _ = skin_on_bed(self.world.look(f"{self.hand}_hand"), self.world.room.bed, inner=True)
        away = points - place
        aside = away - np.outer(away @ along, along)
        away = away[(np.abs(away @ along) < ALONG) & (np.linalg.norm(aside, axis=1) < NEAR)]
        if len(away) < LEAST:
            return posture
        across = np.cross(along, UP)
        middle = np.percentile(away @ across, (5, 95)).mean() * across
        return swung_to(self, self.side, grip, place + middle + (np.percentile(away[:, 2], 90) - WRIST_RADIUS) * UP)


class RaiseWrist(Skill):
    """Raises a wrist that a hand holds, straight up, no harder than an arm may be held."""

    hold = Input(Hold, doc="the hand that holds the arm")
    height = Input(float, unit="m", default=0.1, doc="of the way")
    reasons = (Reason.ARM_SLIPPED,)

    def steps(self) -> Iterator[None]:
        """Up, slower under a heavy arm, until the way or the time is over."""
        n, end = SIDES.index(self.hold.hand), self.now() + 15.0
        goal = hand_now(self, self.hold.hand)[2, 3] + self.height
        load = 0.0
        while hand_now(self, self.hold.hand)[2, 3] < goal and self.now() < end:
            if lost_arm(self, self.hold.hand):
                raise SkillFailure(Reason.ARM_SLIPPED, "on the way up")
            load = float(np.linalg.norm(self.world.observe().wrench_hand_in_map[n, :3]))
            up = 0.02 * float(np.clip((27.0 - load) / 8.0, 0.0, 1.0)) * UP
            self.world.send(HandTwist(side=self.hold.hand, twist_in_map=np.append(up, np.zeros(3))))
            yield
        self.note(f"{load:.0f} N at the top")


class SwingOut(LiftWrist):
    """Swings an arm out by its wrist, a little above the mattress; the base comes along to `stand`."""

    stand = Input(np.ndarray, unit="m, m, rad, map", doc="base pose (3,) in the end")

    def _lift(self) -> Iterator[None]:
        """As an arm is lifted, but for the end of the swing, which need not be in reach from where the base is now."""
        goal, take = self.tuning.goal, self.tuning.take
        yield from open_gripper(self, self.hand)
        above = over_arm(watch_arm(self, self.side, period=0.0), goal.grip_coordinate, lift=goal.approach_height)
        above = top_down_reachable(self, self.hand, above)
        yield from move_hands(self, {self.hand: above}, way="any", speed=careful(self, take.approach_speed))
        posture, around = self.look_again(), above.copy()
        around[:3, 3] = ArmPath.of(posture).point(goal.grip_coordinate) + take.grip_depth * above[:3, 2]
        yield from close_around(self, self.hand, above, around, tuning=take)
        self.hold = Hold(self.hand, goal.grip_coordinate)
        seen, limits = self.world.observe(), self.world.robot.limits
        way = np.stack((seen.pose_base_in_map[:2], self.stand[:2]))
        follower, n, most = (
            PathFollower(way, float(self.stand[2]), limits, speed=ALONGSIDE),
            SIDES.index(self.hand),
            0.0,
        )
        for _ in self._swing(posture, goal):
            seen = self.world.observe()
            most = max(most, float(np.linalg.norm(seen.wrench_hand_in_map[n, :3])))
            if not follower.done(seen.pose_base_in_map):
                command = follower.command(seen.pose_base_in_map)
                self.world.send(BaseVelocity(velocity=command.velocity * (1.0, 1.0, 0.3), duration=command.duration))
            yield
        self.note(f"{most:.0f} N at most")


def limp(context: Context) -> Stage:
    """One arm into its sleeve as far as it goes, begun with the gown on the legs."""
    head, foot = LIFTING[SIDE], PULLING[SIDE]
    arm = Scope(context, f"{SIDE} arm", keys=("grip",), side=SIDE)
    slid, held = Scope(arm, keys=("hold",)), Scope(arm, "wrist", keys=("hold",))

    def strap_from(x: float, y: float) -> Behaviour:
        here = Scope(arm, f"at {y}")
        return sequence(
            f"the strap from {x}, {y}",
            back_off("free", here),
            Navigate("go", here, goal=at(x, y)),
            LookAtPerson("look", here),
            LookForSleeve("look for it", here, hand=head),
            GraspSleeve("grasp", here, hand=head),
        )

    def lower(name: str, scope: Scope, hand: Side) -> ReleaseArm:
        return ReleaseArm(name, scope, hand=hand, lower=True, ready="if possible", tuning=OVER_THE_EDGE)

    return timed_stage(
        "limp",
        Retreat("bring the arms back", arm, hand_distance=0.05),
        Navigate("go to its side", arm, goal=f"bed_{SIDE}"),
        Navigate("come to it", arm, goal=at(*ARM_STAND)),
        arm_in_view(arm),
        LiftArm("slide it out", slid, hand=head, tuning=SLIDE),
        lower("leave it there", arm, head),
        fallback("the strap", *(strap_from(*stand) for stand in STRAP_STANDS)),
        PresentSleeve("present", arm, max_load=4.0),
        PullAlongArm("to the elbow", arm, grip_goal=0.98, stand=at(*WRIST_STAND)),
        LookAtPerson("look at the hand", arm),
        LiftWrist("raise it", held, hand=foot, tuning=RAISE),
        PullAlongArm("past the elbow", held, grip_goal=0.15, max_load=4.2),
        RaiseWrist("raise it on", held),
        PullAlongArm("to the shoulder", held, grip_goal=-0.45, armhole_goal=-0.25, max_load=4.2),
        lower("lower it", held, foot),
        back_off("back off", arm, 0.25),
        seconds=400.0,
    )


def wide(context: Context) -> Stage:
    """Begun with the sleeve past the elbow: the arm across the edge of the bed, and the sleeve drawn on."""
    arm = Scope(context, f"{SIDE} arm", keys=("grip",), side=SIDE)
    held = Scope(arm, "wide", keys=("hold",))
    return timed_stage(
        "wide",
        Retreat("bring the arms back", arm, hand_distance=0.05),
        Navigate("go to its side", arm, goal=f"bed_{SIDE}"),
        arm_in_view(arm),
        Navigate("go below it", arm, goal=at(*BELOW[0], STANCES.heading)),
        SwingOut("swing it out", held, hand=LIFTING[SIDE], tuning=SWING, stand=at(*BELOW[1], STANCES.heading)),
        GraspSleeve("take the strap", held, hand=PULLING[SIDE], worn=True),
        PullAlongArm("to the shoulder", held, grip_goal=-0.45, armhole_goal=-0.25, max_load=5.0),
        ReleaseArm("lay it down", held, hand=LIFTING[SIDE], lower=True, ready="if possible", tuning=LIES_WIDE),
        back_off("back off", arm, 0.25),
        seconds=400.0,
    )


def at(x: float, y: float, heading: float | None = None) -> np.ndarray:
    """Base pose (3,) at `x` and `y` of a right arm's side, mirrored for a left one; it faces the bed [m, m, rad]."""
    facing = np.pi if SIDE == "right" else 0.0
    return np.array((x * outwards(SIDE)[0], y, facing if heading is None else heading))


STAGES = {"limp": TaskStage(limp, begins="gown_on_person"), "wide": TaskStage(wide, begins="gown_on_person")}


def build(context: Context, stages: tuple[str, ...] = ("limp",)) -> Behaviour:
    """The stage, and what is owed to the person where it fails."""
    body = sequence("limp arm", *(STAGES[stage].build(context) for stage in stages))
    return FailSafe("safely", body, make_safe(context))


def armhole_up(record: Path) -> np.ndarray:
    """How far up the upper arm the middle of the armhole is in each frame (T,): 0 elbow, 1 shoulder, nan beside it."""
    with np.load(record / "truth.npz") as truth:
        shoulder, elbow = truth["arms"][:, 1, 0], truth["arms"][:, 1, 1]
        armhole = truth["vertices"][:, truth[f"loop_armhole_{SIDE}"]].mean(axis=1)
    upper = shoulder - elbow
    up = np.einsum("ij,ij->i", armhole - elbow, upper) / np.einsum("ij,ij->i", upper, upper)
    return np.where(np.linalg.norm(armhole - elbow - up[:, None] * upper, axis=1) < NEAR, up, np.nan)


if __name__ == "__main__":
    for name in sys.argv[1:]:
        up = armhole_up(Path(name))
        print(f"{name}: the armhole at most {np.nanmax(up):.2f} up the upper arm, {up[-1]:.2f} in the end")
