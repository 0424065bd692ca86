"""The worlds of the package keep the contract, and every planted defect is found and named."""

import sys
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from caretree.sim.bullet.world import BulletWorld
from caretree.sim.scripted.clock import SteppedClock
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.testing import LAWS, Breaks, WorldLawBroken, check_world
from caretree.sim.world import BaseVelocity, EmergencyStop, GripperOpening, HandTwist, JointTrajectory, SensorLost


def no_wall():
    """A wall clock on which nothing takes any time."""
    return 0.0


class Breakable(ScriptedWorld):
    """Can be broken on purpose, and tells so."""

    dead = pressed = stands = False

    def observe(self):
        if self.dead:
            raise SensorLost("no joint states arrive")
        return replace(super().observe(), emergency_stop=self.pressed)

    def send(self, command):
        if self.pressed:
            raise EmergencyStop("the red button on the base")
        return super().send(command)

    def _advance_to(self, time):
        super()._advance_to(self.time.time if self.stands else time)


BREAKS = Breaks(
    senses=lambda world: setattr(world, "dead", True),
    clock=lambda world: setattr(world, "stands", True),
    emergency_stop=lambda world: setattr(world, "pressed", True),
)


def test_the_scripted_world_keeps_every_law():
    assert check_world(lambda: ScriptedWorld(seed=100), wall=no_wall) == ["senses", "clock", "emergency_stop"]


def test_a_world_that_is_broken_on_purpose_tells_so():
    assert check_world(Breakable, breaks=BREAKS, wall=no_wall) == []


def test_the_simulated_room_keeps_every_law():
    def make():
        world = BulletWorld(seed=100)
        world.remove_gown()
        return world

    check_world(make, wall=no_wall)


class SilentClipping(ScriptedWorld):
    """Says that the fingers opened as wide as they were told to."""

    def send(self, command):
        super().send(command)
        return command


class OldSamples(ScriptedWorld):
    """Gives each observation for two seconds."""

    last = None

    def observe(self):
        if self.last is None or self.clock.now() - self.last.time > 2.0:
            self.last = super().observe()
        return self.last


class SilentForce(ScriptedWorld):
    def observe(self):
        seen = super().observe()
        seen.wrench_hand_in_map[1] = 0.0
        return seen


class NoNumber(ScriptedWorld):
    def observe(self):
        seen = super().observe()
        seen.wrench_hand_in_map[0, 2] = np.nan
        return seen


class LosesTrajectories(ScriptedWorld):
    def send(self, command):
        return command if isinstance(command, JointTrajectory) else super().send(command)


class FallsShort(ScriptedWorld):
    def send(self, command):
        if isinstance(command, JointTrajectory):
            start = command.positions[:1]
            super().send(replace(command, positions=start + 0.5 * (command.positions - start)))
            return command
        return super().send(command)


class MovesTheOtherArm(ScriptedWorld):
    def send(self, command):
        if isinstance(command, JointTrajectory):
            other = {"left": "right", "right": "left", "head": "head"}
            joints = tuple("_".join((other[name.split("_")[0]], name.split("_")[1])) for name in command.joints)
            super().send(replace(command, joints=joints))
            return command
        return super().send(command)


class StopsOnce(ScriptedWorld):
    stopped = False

    def stop(self):
        if self.stopped and not self._motions:
            raise RuntimeError("there is no goal to cancel")
        self.stopped = True
        super().stop()


class GoalArrivesLate(ScriptedWorld):
    """A goal reaches the robot 0.1 s after it was sent, and a stop does not find it before."""

    waiting = None

    def send(self, command):
        if isinstance(command, JointTrajectory):
            self.waiting = self.clock.now() + 0.1, command
            return command
        return super().send(command)

    def _advance_to(self, time):
        if self.waiting and time >= self.waiting[0]:
            goal, self.waiting = self.waiting[1], None
            super()._advance_to(max(self.time.time, time - 0.05))
            super().send(goal)
        super()._advance_to(time)


class SaysNoRobot(ScriptedWorld):
    def __init__(self):
        super().__init__()
        self.robot = "baxter"

    def observe(self):
        raise AssertionError("it is asked for its robot first")


class TakesAnyJoint(ScriptedWorld):
    def send(self, command):
        known = getattr(command, "joints", self.robot.commanded_joints[:1])
        return super().send(command) if known[0] in self.robot.commanded_joints else command


class LateClock(ScriptedWorld):
    def _advance_to(self, time):
        super()._advance_to(time + 0.5 if time > self.time.time else time)


class DeadClock(ScriptedWorld):
    def _advance_to(self, time):
        super()._advance_to(min(time, 0.3))


class ClockGoesBack(ScriptedWorld):
    def __init__(self):
        super().__init__()
        clock = self.clock

        class Back(SteppedClock):
            def now(self):
                return clock.now()

            def wait_until(self, time):
                if time < clock.now():
                    clock.time = time
                clock.wait_until(time)

        self.clock = Back(lambda time: None)


class Blocks(ScriptedWorld):
    """A wall clock whose waits take 5 s."""

    def __init__(self):
        super().__init__()
        self.wall = 0.0
        self.clock = SimpleNamespace(now=self.time.now, wait_until=self.block)

    def block(self, time):
        self.wall += 5.0 if time - self.time.now() > 1.0 else 0.0
        self.time.wait_until(time)


class TwistGoesOn(ScriptedWorld):
    def send(self, command):
        if isinstance(command, HandTwist):
            super().send(replace(command, duration=command.duration + 0.4))
            return command
        return super().send(command)


class TwistInTheBase(ScriptedWorld):
    def send(self, command):
        if isinstance(command, HandTwist):
            x, y = command.twist_in_map[:2]
            turned = np.concatenate(((-y, x), command.twist_in_map[2:]))
            super().send(replace(command, twist_in_map=turned))
            return command
        return super().send(command)


class BaseInTheMap(ScriptedWorld):
    def send(self, command):
        if isinstance(command, BaseVelocity):
            x, y, turn = command.velocity
            super().send(replace(command, velocity=np.array((-y, x, turn))))
            return command
        return super().send(command)


class StopOpensTheFingers(ScriptedWorld):
    def stop(self):
        super().stop()
        super().send(GripperOpening(side="left", opening=0.085))


class SharedArrays(ScriptedWorld):
    """Hands its own arrays out."""

    def observe(self):
        return replace(super().observe(), arm_positions=self._q)


class OldFrames(ScriptedWorld):
    def look(self, camera):
        return replace(super().look(camera), stamp=0.0)


class OtherCamera(ScriptedWorld):
    def look(self, camera):
        return replace(super().look(camera), camera="head")


class DeepFrames(ScriptedWorld):
    def look(self, camera):
        frame = super().look(camera)
        return replace(frame, depth=np.where(frame.depth > 1.5, np.nan, frame.depth))


class AnyCamera(ScriptedWorld):
    def look(self, camera):
        return {"head": 1}[camera] if camera == "tail" else super().look(camera)


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        (
            SilentClipping,
            r"what was really sent comes back: 0\.500 m came back for the left fingers, which stand 0\.085 m",
        ),
        (OldSamples, r"observations are new and vary: an observation is 0\.\d+ s old"),
        (
            SilentForce,
            r"observations are new and vary: the wrench of the right hand has repeated every bit for 1\.\d s",
        ),
        (NoNumber, "an observation is whole: wrench_hand_in_map holds a number that is not finite"),
        (LosesTrajectories, r"a trajectory ends where it should: left_w2 ended 0\.150 rad from where it was sent"),
        (FallsShort, r"a trajectory ends where it should: left_w2 ended 0\.075 rad"),
        (MovesTheOtherArm, r"a trajectory ends where it should: left_w2 ended 0\.150 rad"),
        (StopsOnce, r"stop\(\) raised RuntimeError|RuntimeError: there is no goal to cancel"),
        (
            GoalArrivesLate,
            r"stopping right after a command ends it: a trajectory that was stopped at once moved 0\.\d+",
        ),
        (SaysNoRobot, "it says what its robot is made of: robot is 'baxter', but a RobotModel is asked for"),
        (TakesAnyJoint, "a joint that the robot does not have is refused: .* 'third_elbow' was taken"),
        (LateClock, r"the clock goes on and never back: a wait came back 0\.50 s too late"),
        (DeadClock, "the clock goes on and never back: the world's clock stands still"),
        (ClockGoesBack, r"a wait for the past is over at once: it turned the clock back by 1\.00 s"),
        (Blocks, r"a wait comes back within a tenth of a second: it took 5\.00 s of wall time"),
        (TwistGoesOn, r"a twist lasts its duration: the left hand, sent 0\.030 m along z of the map, moved 0\.05\d m"),
        (
            TwistInTheBase,
            r"a twist lasts its duration: the left hand, sent 0\.030 m along x of the map, moved -?0\.000 m",
        ),
        (BaseInTheMap, r"the base drives for its duration: sent -0\.060 m ahead it drove -?0\.000 m"),
        (StopOpensTheFingers, r"fingers go where they are sent and stay: stop\(\) moved the left fingers"),
        (SharedArrays, "an observation stays as it is: arm_positions of an observation changed as the robot moved"),
        (OldFrames, r"frames are whole new and in place: .*is \d+\.\d s old"),
        (OtherCamera, "frames are whole new and in place: left_hand was asked for, an image of head came"),
        (DeepFrames, "frames are whole new and in place: depth of the head image holds what is no distance"),
        (AnyCamera, "an unknown camera is lost: it raised KeyError, but SensorLost is asked for"),
    ],
    ids=lambda value: value.__name__ if isinstance(value, type) else "",
)
def test_a_planted_defect_is_found_and_named(kind, said):
    made = []

    def make():
        made.append(kind())
        return made[-1]

    with pytest.raises(WorldLawBroken, match=f"^{kind.__name__}: .*({said})"):
        check_world(make, wall=lambda: getattr(made[-1], "wall", 0.0))


class ForgetsThatItDied(Breakable):
    def observe(self):
        if self.dead:
            return replace(self.kept, time=self.clock.now())
        self.kept = super().observe()
        return self.kept


class ForgetsTheButton(Breakable):
    def observe(self):
        return replace(super().observe(), emergency_stop=False)


class TakesCommandsAllTheSame(Breakable):
    def send(self, command):
        return ScriptedWorld.send(self, command)


class GoesOn(Breakable):
    def _advance_to(self, time):
        ScriptedWorld._advance_to(self, time)


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        (ForgetsThatItDied, "dead senses are lost: an observation of 0.00 s ago is given as a new one"),
        (ForgetsTheButton, "the emergency stop is told: the observation does not say that it is pressed"),
        (TakesCommandsAllTheSame, "the emergency stop is told: a command was taken as if nothing were pressed"),
        (GoesOn, "a dead clock is told: it goes on"),
    ],
    ids=lambda value: value.__name__ if isinstance(value, type) else "",
)
def test_a_defect_that_shows_in_a_broken_world_is_found_and_named(kind, said):
    with pytest.raises(WorldLawBroken, match=said):
        check_world(kind, breaks=BREAKS, wall=no_wall)


def test_every_law_says_what_it_asks_for():
    assert all(law.__doc__ for law in LAWS)
    assert len({law.__name__ for law in LAWS}) == len(LAWS)


def test_a_broken_law_leaves_no_robot_moving(monkeypatch):
    monkeypatch.setattr(sys.modules[check_world.__module__], "AGAIN", 0.0)

    class Busy(ScriptedWorld):
        stops, ended = 0, False

        def observe(self):
            if self.clock.now() > 3.0:
                raise SensorLost("no joint states arrive")
            return super().observe()

        def stop(self):
            self.stops += 1
            if self.clock.now() > 3.0 and self.stops % 2:
                raise RuntimeError("busy")
            super().stop()
            self.ended = self.clock.now() > 3.0

        def close(self):
            assert self.ended, "it was closed while it may still move"

    with pytest.raises(WorldLawBroken):
        check_world(Busy, wall=no_wall)
