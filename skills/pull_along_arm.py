"""Stage C: pull a sleeve along the arm, first keeping the force low, then following the arm as it is tracked."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

import numpy as np

from ..sim.world import SIDES, BaseVelocity, HandTwist, Observation
from .belief.armhole_watch import ARMHOLE_WATCH, ArmholeWatch
from .belief.person_tracking import watch_arm
from .control.compliant_hold import ease_hold, while_holding
from .control.hands import hand_now, look_towards
from .control.pull_law import PullLaw
from .core.ports import Input
from .core.reasons import Reason, SkillFailure
from .core.skill import Skill
from .geometry.arm_path import ArmPath
from .geometry.hold import Hold
from .geometry.strap_grip import StrapGrip, presenting
from .motion.drive import PathFollower

SPEED = 0.08  # along the arm; the guard lets the base come along with what is left of a hand's speed [m/s]
BASE_SPEED = 0.10  # of the base at most [m/s]
_WAIT = 1.0  # how long a hand that cannot go on lets the base come along alone [s]
CAUGHT = 5.0  # a sleeve that pulls harder than this and does not come on is caught [N]
STUCK_FOR = 1.6  # ... for this long [s]
EASING, SLOWEST = 2.0, 0.3  # slower over the last newtons before it is taut [N], but not below this share of the speed
ADVANCE = 0.01  # the way that counts as coming on [m]
LOST = 0.2  # a sleeve that pulls less than this is no longer held [N]
_BEFORE, _THROUGH, _SURE = 3.15, 2.0, 2.5  # places: of the grip before the hand, past it, and where a miss shows
_LAST = 0.6  # place of the grip from which on the armhole may be at the shoulder
_ON = -0.1  # a grip beyond this place that stands or pulls hard has the sleeve on
_LAGGING, _FARTHER = 0.10, 0.08  # a ring seen that far from its place lets the grip go that much farther
_PATIENCE = 6.0  # how long the armhole may take to be centred before the hand [s]


class PullAlongArm(Skill):
    """Leads the strap above the arm's axis towards the shoulder until it is at `upto`.

    Inputs: `grip`, how the strap is held; `upto`, place along the arm to reach (3 fingertip, 2 wrist, 1 elbow,
    0 shoulder, below 0 past it towards the neck); `seat`, place where the armhole itself should end up, which as far as
    it is seen ends the pull before or a little after `upto`; `hold`, the hand that holds the arm,
    or None; `stand`, base pose (3,) to drift to on the way [m, m, rad], or None to stand still; `taut`, the load that
    ends a pull beyond the shoulder [N]; `law`, constants of the pull.
    """

    grip = Input(StrapGrip)
    upto = Input(float)
    seat = Input(float, default=-np.inf)
    hold = Input(Hold, default=None)
    stand = Input(np.ndarray, default=None)
    taut = Input(float, default=3.7)
    law = Input(PullLaw, default=PullLaw())
    reasons = (
        Reason.SLEEVE_CAUGHT,
        Reason.CLOTH_SLIPPED,
        Reason.ARM_LOST,
        Reason.ARM_SLIPPED,
        Reason.SLEEVE_MISSED,
        Reason.MOTION_BLOCKED,
        Reason.FORCE_LIMIT,
        Reason.COMMAND_LOST,
    )

    def steps(self) -> Iterator[None]:
        """Steer anew on every tick."""
        self.note(f"pulls the {self.grip.arm} sleeve up")
        n = SIDES.index(self.grip.hand)
        arm = ArmPath.of(watch_arm(self, self.grip.arm, hold=self.hold))
        ahead = 0.5 * (arm.coordinate_of(hand_now(self, self.grip.hand)[:3, 3]) + self.upto)
        yield from while_holding(self, self.hold, look_towards(self, arm.point(ahead)))
        follower = None if self.stand is None else self._drift()
        window: deque[tuple[float, float, float]] = deque()  # time, way along the arm, load
        place: float | None = None
        waits_until = -np.inf
        ring, travelled, begun = ArmholeWatch(self, self.grip.arm, self.grip.hand), 0.0, self.now()
        while True:
            path = ArmPath.of(watch_arm(self, self.grip.arm, hold=self.hold))
            seen = self.world.observe()
            hand, load = seen.pose_hand_in_map[n], seen.wrench_hand_in_map[n, :3]
            before, place = place, path.coordinate_of(hand[:3, 3], place)
            if before is not None:
                travelled += np.sign(before - place) * path.distance(before, place)
            if place < _LAST and np.isfinite(self.seat):
                ring.locate(path, hand[:3, 3])
            if self._there(ring.coordinate, place) or (place < _ON and np.linalg.norm(load) > self.taut):
                if self.upto > 1.0 and ring.arm_is_beside(path):
                    raise SkillFailure(Reason.SLEEVE_MISSED, f"the {self.grip.arm} arm shows beside the cuff")
                break
            window.append((seen.time, travelled, float(np.linalg.norm(load))))
            while window[0][0] < seen.time - STUCK_FOR:
                window.popleft()
            if place < _ON and self._stands(window):
                break  # as far as the arm, or the cloth, goes
            if follower is not None and not follower.done(seen.pose_base_in_map) and self._stands(window):
                window.clear()
                waits_until = seen.time + _WAIT  # its arm is at its end, and the base still comes
            else:
                self._judge(window)
            if follower is not None and seen.time < waits_until:
                ease_hold(self, self.hold)
                self._drive(follower, seen)
                yield
                continue
            if place > _THROUGH:
                ring.centre(path, place, hand[:3, 3])
            if before is not None and before > _SURE >= place and ring.hand_is_bare(path):
                raise SkillFailure(Reason.SLEEVE_MISSED, f"the {self.grip.arm} hand shows beside the sleeve")
            ease_hold(self, self.hold)
            linear = self.law.velocity(path, place, hand[:3, 3], ring.offset, SPEED, load)
            if place > 3.0 and abs(ring.error) > ARMHOLE_WATCH.tolerance and seen.time < begun + _PATIENCE:
                along = path.direction(place)  # centre the armhole before the hand enters it
                linear = linear - (1.0 if place < _BEFORE else 0.8) * (linear @ along) * along
                window.clear()  # it waits on purpose
            if place < _ON:  # a hand that is told to stop goes on for centimetres
                linear = linear * np.clip((self.taut - np.linalg.norm(load)) / EASING, SLOWEST, 1.0)
            wanted = presenting(self.grip, path.direction(place), hand[:3, 3])
            twist = np.concatenate((linear, self.law.turn(wanted, hand)))
            self.world.send(HandTwist(side=self.grip.hand, twist_in_map=twist))
            if follower is not None:
                self._drive(follower, seen)
            self.note(f"pulls the {self.grip.arm} sleeve: at {place:.2f}, {np.linalg.norm(load):.1f} N")
            yield

    def _there(self, ring: float | None, grip: float) -> bool:
        """The armhole lags behind the grip, more or less: as far as it is seen, it decides where the pull ends."""
        if ring is None or not np.isfinite(self.seat):
            return grip <= self.upto
        return ring <= self.seat or grip <= self.upto - (_FARTHER if ring > self.seat + _LAGGING else 0.0)

    def _stands(self, window: deque[tuple[float, float, float]]) -> bool:
        """The hand has not come on for a while."""
        if not window or window[-1][0] - window[0][0] < 0.9 * STUCK_FOR:
            return False
        return window[-1][1] - window[0][1] < ADVANCE

    def _judge(self, window: deque[tuple[float, float, float]]) -> None:
        """Tell a sleeve that is caught, one that is lost, and a hand that does not come on."""
        if not window or window[-1][0] - window[0][0] < 0.9 * STUCK_FOR:
            return
        _, way, load = np.array(window).T
        moved = float(way[-1] - way[0])
        if self._stands(window) and load.mean() > CAUGHT:
            raise SkillFailure(Reason.SLEEVE_CAUGHT, f"{load.mean():.1f} N and {moved * 100:.1f} cm in {STUCK_FOR} s")
        if self._stands(window):
            raise SkillFailure(Reason.MOTION_BLOCKED, f"the hand came on {moved * 100:.1f} cm in {STUCK_FOR} s")
        if load.max() < LOST:
            raise SkillFailure(Reason.CLOTH_SLIPPED, f"at most {load.max():.2f} N on the {self.grip.hand} hand")

    def _drift(self) -> PathFollower:
        here = self.world.observe().pose_base_in_map
        return PathFollower(np.stack((here[:2], self.stand[:2])), float(self.stand[2]), speed=BASE_SPEED)

    def _drive(self, follower: PathFollower, seen: Observation) -> None:
        if not follower.done(seen.pose_base_in_map):
            command = follower.command(seen.pose_base_in_map)
            velocity = command.velocity * (1.0, 1.0, 0.3)
            self.world.send(BaseVelocity(velocity=velocity, duration=command.duration))
