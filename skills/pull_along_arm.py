"""Pull a sleeve up the arm, keeping the force low first of all, and along the arm as it is tracked."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np

from ..sim.quantity import Quantities, quantity
from ..sim.world import SIDES, BaseVelocity, HandTwist, Observation
from .belief.armhole_watch import ARMHOLE_WATCH, ArmholeWatch
from .belief.person_motion import while_person_rests
from .belief.person_tracking import careful, watch_arm
from .belief.pulled_sleeves import pull_loads
from .belief.strap_turn import turned_strap
from .control.compliant_hold import ease_hold, while_holding
from .control.hands import hand_now, move_hands, until_load
from .control.head import keep_off_the_arms, look_towards
from .control.load_easing import LoadEasing
from .control.pull_law import PullLaw
from .core.ports import Input
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .geometry.arm_path import ELBOW, ArmPath
from .geometry.hold import Hold
from .geometry.strap_grip import StrapGrip, presenting
from .motion.drive import PathFollower
from .motion.errors import MotionError


@dataclass(frozen=True, kw_only=True)
class PullAlongArmTuning(Quantities):
    """Numbers of the pull.  Arm coordinates are 0 at the shoulder, 1 elbow, 2 wrist, 3 fingertip."""

    speed: float = quantity(
        0.08,
        "m/s",
        "of the grip along the arm",
        "choice: the guard lets the base come along with what is left of a hand's speed",
    )
    base_speed: float = quantity(0.10, "m/s", "of the base at most", "choice: the hand keeps up with it")
    base_turn_share: float = quantity(
        0.3,
        "1",
        "of the yaw rate that its path asks for",
        "choice: a turn of the base moves the hand farther than its way",
    )
    base_alone_time: float = quantity(
        1.0, "s", "for which a hand that cannot go on lets the base come along alone", "choice: 10 cm of the base's way"
    )
    caught_load: float = quantity(
        5.0,
        "N",
        "mean load from which a sleeve that does not come on counts as caught",
        "choice: a sleeve that slides pulls with 1 to 3 N",
    )
    lost_load: float = quantity(
        0.2,
        "N",
        "load below which the sleeve is no longer held",
        "choice: a sleeve that hangs from the hand weighs more",
    )
    stall_time: float = quantity(
        1.6, "s", "over which the hand's advance is judged", "choice: cloth that sticks for a moment is not caught"
    )
    stall_record: float = quantity(
        0.9, "1", "share of that time that must be on record for a judgement", "choice: ticks do not divide it evenly"
    )
    min_advance: float = quantity(
        0.01, "m", "within the stall time, for a hand that comes on", "choice: far less than at full speed"
    )
    near_goal: float = quantity(
        0.2,
        "1",
        "arm coordinate from the goal within which a hand that comes no farther has arrived",
        "measured: held up by the hand that holds the arm at 1.85 of 1.8, past the wrist, a sleeve was taken off the "
        "hand again, and did not come over it in five tries more (164)",
    )
    easing: LoadEasing = field(default_factory=LoadEasing)
    entry: float = quantity(
        3.15, "1", "arm coordinate up to which the grip comes while the armhole is centred", "choice: before the hand"
    )
    approach_slowing: float = quantity(
        0.8,
        "1",
        "share of the speed along the arm that is taken away beyond `entry` while the armhole is centred",
        "choice: the hand must not enter an armhole beside it",
    )
    clear_of_hand: float = quantity(
        0.16,
        "m",
        "beyond the fingertips to which the grip draws back while the armhole is far aside",
        "choice: the hoop, which hangs 0.07 m nearer than the strap, is off the fingers; drawn sideways against them, "
        "it turned round and went past the hand (171)",
    )
    back_speed: float = quantity(
        0.15, "m/s", "of a sleeve that is drawn back off a hand that it missed", "choice: slow beside the person"
    )
    far_aside: float = quantity(
        0.04, "m", "of the armhole's edge off its place, from which it does so", "choice: half of the room it has"
    )
    centring_timeout: float = quantity(
        6.0, "s", "for which the armhole may be centred before the hand", "choice: looks and steps enough to get there"
    )
    centring_end: float = quantity(
        2.0, "1", "arm coordinate of the grip up to which the armhole is centred", "design: the wrist is then inside"
    )
    miss_check: float = quantity(
        2.5, "1", "arm coordinate of the grip where a bare hand is a miss", "design: the middle of the hand"
    )
    armhole_watch: float = quantity(
        0.6,
        "1",
        "arm coordinate of the grip from which on the armhole may be at the shoulder",
        "choice: the armhole lags behind the grip",
    )
    armhole_lag: float = quantity(
        0.10, "1", "of the armhole behind its goal, beyond which the grip goes farther", "choice: less will do"
    )
    extra_way: float = quantity(
        0.08, "1", "by which the grip then goes farther, in upper arms", "choice: bounded, as what is seen may be wrong"
    )
    settle_time: float = quantity(
        0.8,
        "s",
        "waited for a cuff that shows on one side of the arm only",
        "measured: a cuff seen beside the arm lay round it 0.6 s later (113)",
    )
    seated: float = quantity(
        -0.1,
        "1",
        "arm coordinate of the grip beyond which a pull that stands, or pulls hard, has the sleeve on",
        "choice: past the shoulder",
    )
    by_shoulder: float = quantity(
        0.3,
        "1",
        "arm coordinate of the grip beyond which a pull that reaches `most_load` has the sleeve on as far as it goes",
        "measured: pulls that passed 5.5 N did so between 0.15 and 0 (110, 168), with the armhole on the upper arm",
    )
    most_load: float = quantity(
        6.0,
        "N",
        "at which it ends there",
        "measured: at 7.1 to 7.7 N 1 % of a gown's edges were stretched by 25 % and more (163, 165, 168), which "
        "ended runs that were dressed otherwise; at 6 N by 19 to 24 %",
    )
    law: PullLaw = field(default_factory=PullLaw)


class PullAlongArm(Skill):
    """Leads the strap above the arm's axis towards the shoulder until its grip, or the armhole, is at its goal.

    It fails where the sleeve is caught or lost, where it goes beside the hand or the arm, where the hand or the base
    cannot go on, where the arm is lost or slips out of the hand that holds it, and where the person moves.
    """

    grip = Input(StrapGrip, doc="how the strap is held")
    grip_goal = Input(
        float,
        unit="1",
        doc="arm coordinate at which the grip ends the pull: 3 fingertip, 2 wrist, 1 elbow, 0 shoulder, "
        "below 0 past it towards the neck",
    )
    armhole_goal = Input(
        float,
        unit="1",
        default=-np.inf,
        doc="arm coordinate at which the armhole, as far as it is seen, ends the pull before or a little after "
        "`grip_goal`; -inf to leave the armhole out",
    )
    hold = Input(Hold, default=None, doc="the hand that holds the arm, or None")
    stand = Input(
        np.ndarray, unit="m, m, rad, map", default=None, doc="base pose (3,) to drift to, or None to stand still"
    )
    max_load = Input(float, unit="N", default=3.7, doc="load that ends a pull beyond the shoulder")
    tuning = Input(PullAlongArmTuning, default=PullAlongArmTuning(), doc="numbers of this skill")
    reasons = (
        Reason.SLEEVE_CAUGHT,
        Reason.CLOTH_SLIPPED,
        Reason.ARM_LOST,
        Reason.ARM_SLIPPED,
        Reason.PERSON_MOVED,
        Reason.SLEEVE_MISSED,
        Reason.MOTION_BLOCKED,
        Reason.FORCE_LIMIT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Pull as long as the person does not move."""
        yield from while_person_rests(self, self._pull_or_draw_back())

    def _pull_or_draw_back(self) -> Iterator[None]:
        """Pull; a sleeve that goes past the hand is drawn back off it before the failure is told."""
        try:
            yield from self._pull()
        except SkillFailure as failure:
            if failure.reason == Reason.SLEEVE_MISSED:
                yield from self._draw_back()
            raise

    def _draw_back(self) -> Iterator[None]:
        """Beyond the fingertips, the way it came, as far as the cloth lets it.

        Laid down from beside the arm, the sleeve left the gown hanging over the arm, and all slid off the bed (171).
        """
        tuning, hand = self.tuning, self.grip.hand
        path = ArmPath.of(watch_arm(self, self.grip.arm, hold=self.hold))
        place = path.moved(3.0, tuning.clear_of_hand)
        over = path.point(place) + tuning.law.clearance * path.frame(place)[:, 2]
        goal = presenting(turned_strap(self, self.grip), path.direction(place), over)
        motion = move_hands(self, {hand: goal}, speed=careful(self, tuning.back_speed), way="line")
        with suppress(MotionError):
            yield from while_holding(self, self.hold, until_load(self, hand, tuning.caught_load, motion))

    def _pull(self) -> Iterator[None]:
        """Steer anew on every tick."""
        self.note(f"pulls the {self.grip.arm} sleeve up")
        pull_loads(self.context).pop(self.grip.arm, None)
        arm = ArmPath.of(watch_arm(self, self.grip.arm, hold=self.hold))
        ahead = 0.5 * (arm.coordinate_of(hand_now(self, self.grip.hand)[:3, 3]) + self.grip_goal)
        yield from while_holding(self, self.hold, look_towards(self, arm.point(ahead)))
        follower = None if self.stand is None else self._drift()
        pull = _Pull(follower=follower, armhole=ArmholeWatch(self, self.grip.arm, self.grip.hand), begun=self.now())
        while True:
            now = self._observe(pull)
            if self._at_goal(pull, now) or self._stands_there(pull, now):
                break
            if self._waits_for_base(pull, now):
                ease_hold(self, self.hold)
                self._drive(pull, now.seen)
                yield
                continue
            self._look_at_armhole(pull, now)
            keep_off_the_arms(self, now.path.point(0.5 * (now.coordinate + self.grip_goal)))
            ease_hold(self, self.hold)
            linear = self._velocity(pull, now)
            wanted = presenting(turned_strap(self, self.grip), now.path.direction(now.coordinate), now.hand[:3, 3])
            twist = np.concatenate((linear, self.tuning.law.turn(wanted, now.hand)))
            self.world.send(HandTwist(side=self.grip.hand, twist_in_map=twist))
            self._drive(pull, now.seen)
            self.note(f"pulls the {self.grip.arm} sleeve: at {now.coordinate:.2f}, {now.size:.1f} N")
            yield
        if self.grip_goal > ELBOW:  # the pull ends on the forearm
            yield from self._see_arm_inside(pull.armhole)
        else:
            pull_loads(self.context)[self.grip.arm] = now.size

    def _observe(self, pull: _Pull) -> _Now:
        """Arm, hand and load of this tick; counts the way that the hand has come."""
        path = ArmPath.of(watch_arm(self, self.grip.arm, hold=self.hold))
        seen, n = self.world.observe(), SIDES.index(self.grip.hand)
        hand, load = seen.pose_hand_in_map[n], seen.wrench_hand_in_map[n, :3]
        before, pull.coordinate = pull.coordinate, path.coordinate_of(hand[:3, 3], pull.coordinate)
        if before is not None:
            pull.travelled += np.sign(before - pull.coordinate) * path.distance(before, pull.coordinate)
        return _Now(
            path=path,
            seen=seen,
            hand=hand,
            load=load,
            size=float(np.linalg.norm(load)),
            coordinate=pull.coordinate,
            before=before,
        )

    def _at_goal(self, pull: _Pull, now: _Now) -> bool:
        """Whether grip, armhole or load end the pull here."""
        if now.coordinate < self.tuning.armhole_watch and np.isfinite(self.armhole_goal):
            pull.armhole.locate(now.path, now.hand[:3, 3])
        hard = now.coordinate < self.tuning.seated and now.size > self.max_load
        stretched = now.coordinate < self.tuning.by_shoulder and now.size > self.tuning.most_load
        return hard or stretched or self.arrived(pull.armhole.coordinate, now.coordinate)

    def _see_arm_inside(self, armhole: ArmholeWatch) -> Iterator[None]:
        """Look whether the arm is inside the cuff of a sleeve that has come to rest on the forearm.

        The cuff of a sleeve that came in askew swings round the arm only after the strap has stopped.

        Raises:
            SkillFailure: SLEEVE_MISSED when the arm still shows beside the cuff.
        """
        for settling in (True, False):
            if not armhole.arm_is_beside(ArmPath.of(watch_arm(self, self.grip.arm, hold=self.hold))):
                return
            if settling:
                self.world.stop()
                yield from while_holding(self, self.hold, self.wait(self.tuning.settle_time))
        raise SkillFailure(Reason.SLEEVE_MISSED, f"the {self.grip.arm} arm shows beside the cuff")

    def arrived(self, armhole: float | None, grip: float) -> bool:
        """Whether the pull is at its goal.  The armhole lags behind the grip, and decides as far as it is seen.

        Args:
            armhole: its arm coordinate, None where it is not seen.
            grip: arm coordinate of the grip.
        """
        if armhole is None or not np.isfinite(self.armhole_goal):
            return grip <= self.grip_goal
        lags = armhole > self.armhole_goal + self.tuning.armhole_lag
        return armhole <= self.armhole_goal or grip <= self.grip_goal - (self.tuning.extra_way if lags else 0.0)

    def _stands_there(self, pull: _Pull, now: _Now) -> bool:
        """Put this tick on record; whether the hand stands past the shoulder, or near its goal, and goes no farther."""
        pull.window.append((now.seen.time, pull.travelled, now.size))
        while pull.window[0][0] < now.seen.time - self.tuning.stall_time:
            pull.window.popleft()
        there = now.coordinate < max(self.tuning.seated, self.grip_goal + self.tuning.near_goal)
        return there and self._stands(pull.window)

    def _waits_for_base(self, pull: _Pull, now: _Now) -> bool:
        """Whether the base comes along alone now; where the hand stands although the base has arrived, it fails."""
        follower = pull.follower
        if follower is not None and not follower.done(now.seen.pose_base_in_map) and self._stands(pull.window):
            pull.window.clear()
            pull.waits_until = now.seen.time + self.tuning.base_alone_time  # the robot's arm is at its end
        else:
            self._judge(pull.window)
        return follower is not None and now.seen.time < pull.waits_until

    def _look_at_armhole(self, pull: _Pull, now: _Now) -> None:
        """Centre the armhole until the wrist is inside.

        Raises:
            SkillFailure: SLEEVE_MISSED when the hand shows beside the sleeve.
        """
        if now.coordinate > self.tuning.centring_end:
            pull.armhole.centre(now.path, now.coordinate, now.hand[:3, 3])
        crossed = now.before is not None and now.before > self.tuning.miss_check >= now.coordinate
        if crossed and pull.armhole.hand_is_bare(now.path):
            raise SkillFailure(Reason.SLEEVE_MISSED, f"the {self.grip.arm} hand shows beside the sleeve")

    def _velocity(self, pull: _Pull, now: _Now) -> np.ndarray:
        """Velocity (3,) of the grip: slower while the armhole is centred, and near the greatest load [m/s]."""
        tuning, place = self.tuning, now.coordinate
        linear = tuning.law.velocity(now.path, place, now.hand[:3, 3], pull.armhole.offset, tuning.speed, now.load)
        beside = abs(pull.armhole.error) > ARMHOLE_WATCH.tolerance
        if place > 3.0 and beside and now.seen.time < pull.begun + tuning.centring_timeout:  # before the fingertip
            along = now.path.direction(place)
            linear = linear - (1.0 if place < tuning.entry else tuning.approach_slowing) * (linear @ along) * along
            if abs(pull.armhole.error) > tuning.far_aside and place < now.path.moved(3.0, tuning.clear_of_hand):
                linear = linear + tuning.speed * along
            pull.window.clear()  # it waits on purpose
        if place < tuning.seated:
            linear = linear * tuning.easing.share(now.load, self.max_load)
        return linear

    def _stands(self, window: deque[tuple[float, float, float]]) -> bool:
        """Whether the hand has not come on for the stall time."""
        return self._on_record(window) and window[-1][1] - window[0][1] < self.tuning.min_advance

    def _on_record(self, window: deque[tuple[float, float, float]]) -> bool:
        """Whether enough of the stall time is on record for a judgement."""
        if not window:
            return False
        return window[-1][0] - window[0][0] >= self.tuning.stall_record * self.tuning.stall_time

    def _judge(self, window: deque[tuple[float, float, float]]) -> None:
        """Tell a sleeve that is caught, one that is lost, and a hand that does not come on.

        Raises:
            SkillFailure: SLEEVE_CAUGHT, CLOTH_SLIPPED or MOTION_BLOCKED.
        """
        if not self._on_record(window):
            return
        _, way, load = np.array(window).T
        advance = f"{float(way[-1] - way[0]) * 100:.1f} cm in {self.tuning.stall_time} s"
        if self._stands(window) and load.mean() > self.tuning.caught_load:
            raise SkillFailure(Reason.SLEEVE_CAUGHT, f"{load.mean():.1f} N and {advance}")
        if self._stands(window):
            raise SkillFailure(Reason.MOTION_BLOCKED, f"the hand came on {advance}")
        if load.max() < self.tuning.lost_load:
            raise SkillFailure(Reason.CLOTH_SLIPPED, f"at most {load.max():.2f} N on the {self.grip.hand} hand")

    def _drift(self) -> PathFollower:
        here = self.world.observe().pose_base_in_map
        way = np.stack((here[:2], self.stand[:2]))
        return PathFollower(way, float(self.stand[2]), self.world.robot.limits, speed=self.tuning.base_speed)

    def _drive(self, pull: _Pull, seen: Observation) -> None:
        """Let the base come along, where it has a stand to go to and is not there."""
        if pull.follower is not None and not pull.follower.done(seen.pose_base_in_map):
            command = pull.follower.command(seen.pose_base_in_map)
            velocity = command.velocity * (1.0, 1.0, self.tuning.base_turn_share)
            self.world.send(BaseVelocity(velocity=velocity, duration=command.duration))


@dataclass
class _Pull:
    """What a pull remembers from tick to tick.

    Attributes:
        follower: of the base's way, None where the base stands still.
        armhole: what is seen of it.
        begun: when the pull began [s].
        coordinate: of the grip along the arm at the last tick.
        travelled: way along the arm so far [m].
        waits_until: when the base no longer comes along alone [s].
        window: time [s], way along the arm [m] and load [N] over the stall time.
    """

    follower: PathFollower | None
    armhole: ArmholeWatch
    begun: float
    coordinate: float | None = None
    travelled: float = 0.0
    waits_until: float = -np.inf
    window: deque[tuple[float, float, float]] = field(default_factory=deque)


@dataclass(frozen=True, kw_only=True)
class _Now:
    """One tick: the arm, the pose (4, 4) of the hand, the load (3,) and its size [N], and where along the arm that is.

    `before` is the arm coordinate of the tick before, None on the first one.
    """

    path: ArmPath
    seen: Observation
    hand: np.ndarray
    load: np.ndarray
    size: float
    coordinate: float
    before: float | None
