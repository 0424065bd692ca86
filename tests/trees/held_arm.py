"""A task that takes a person's arm, raises and holds it until it is stopped, on a scripted world with a record.

`caretree run tests/trees/held_arm.py --world scripted` runs it too.
"""

from functools import partial
from pathlib import Path

import numpy as np
from caretree.sim.fence import fenced
from caretree.sim.record.recorder import FRAME_PERIOD
from caretree.sim.record.truth import LOOPS, TruthFrame, TruthStatic
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import GripperOpening, HandTwist
from caretree.skills.core.ports import Input
from caretree.skills.core.reasons import Reason, SkillFailure
from caretree.skills.core.skill import Skill
from caretree.trees.nodes.composers import sequence
from caretree.trees.nodes.decorators import FailSafe, Retry, Stage

FILE = Path(__file__)
ARM = 0.07  # [m] between the fingers
LYING = 1.0  # [m] height of the left hand at the beginning
SPEED = 0.04  # [m/s] of the arm up and down
RISE = 1.2  # [s]


class RecordedWorld(ScriptedWorld):
    """A world that gives frames and pictures to a recorder while its time passes, as the simulated room does.

    Attributes:
        let_go_at: height of the left hand each time that its fingers let the arm go [m].
    """

    def __init__(self, seed=0, size=64):
        super().__init__(seed=seed)
        self.between_fingers["left"] = ARM
        self.let_go_at = []
        self._size = size
        self._watch = None
        self._next = 0.0

    def attach_recorder(self, recorder, on_error):
        recorder.begin(
            TruthStatic(
                faces=np.array([[0, 1, 2]]),
                rest_vertices=np.zeros((self._size, 3)),
                loops=dict.fromkeys(LOOPS, np.arange(3)),
                arm_radii=np.full((2, 3), 0.05),
                person_parts=("trunk",),
                robot_capsule_names=("left_finger_1",),
                person_capsules=np.zeros((1, 7)),
                person_capsule_names=("trunk",),
                bed_top=0.6,
                face=np.zeros(6),
                neckline=np.arange(3),
            )
        )
        self._watch = fenced(partial(self._record, recorder), on_error)

    def send(self, command):
        if isinstance(command, GripperOpening) and command.opening > ARM and self.observe().gripper_force[0] > 0.0:
            self.let_go_at.append(float(self.observe().pose_hand_in_map[0, 2, 3]))
        return super().send(command)

    def _advance_to(self, time):
        while self._watch is not None and self._next < time:
            super()._advance_to(self._next)
            self._next += FRAME_PERIOD
            self._watch()
        super()._advance_to(time)

    def _record(self, recorder):
        now = self.time.time
        recorder.frame(
            TruthFrame(
                t=now,
                vertices=np.zeros((self._size, 3)),
                arms=np.zeros((2, 4, 3)),
                torso_front=np.zeros((100, 6)),
                gripper_pose=np.zeros((2, 7)),
                gripper_closed=np.zeros(2, bool),
                gripper_load=np.zeros((2, 3)),
                person_force=np.zeros(1),
                robot_capsules=np.zeros((1, 7)),
                holds_arm=np.array((0, -1)),
            )
        )
        recorder.picture(now, np.full((48, 64, 3), round(100 * now) % 256, np.uint8))


class Take(Skill):
    """Closes the left fingers around the arm."""

    def steps(self):
        self.world.send(GripperOpening(side="left", opening=0.0))
        yield from self.until(lambda: self.world.observe().gripper_force[0] > 0.0, timeout=3.0)
        self.context.guard.declare_grip("left", "arm")


class Carry(Skill):
    """Moves the held arm up or down."""

    speed = Input(float)

    def steps(self):
        end = self.now() + RISE
        while self.now() < end:
            self.world.send(HandTwist(side="left", twist_in_map=np.array((0, 0, self.speed, 0, 0, 0))))
            yield


class Hold(Skill):
    """Holds the arm for a second, and does not find this enough."""

    reasons = (Reason.TIMEOUT,)

    def steps(self):
        yield from self.wait(1.0)
        raise SkillFailure(Reason.TIMEOUT)


class Open(Skill):
    """Opens the fingers."""

    def steps(self):
        self.world.send(GripperOpening(side="left", opening=0.085))
        yield from self.until(lambda: self.world.observe().gripper_opening[0] > 0.08, timeout=3.0)


def build(context):
    """Take the arm, raise it, hold it and show a line twice in a second, until somebody ends the run."""
    hold = Retry("on and on", Hold("hold", context), attempts=10**6)
    body = sequence("hold it", Take("take", context), Carry("raise", context, speed=SPEED), hold)
    safe = sequence("make safe", Carry("lower", context, speed=-SPEED), Open("let go", context))
    return FailSafe("safely", Stage("arm held", None, body), safe)


def scripted(seed):
    """The world to try it on."""
    return RecordedWorld(seed=seed), None


def put_down(events):
    """Whether a trace shows that the arm was taken, lowered, and then let go, in this order."""
    said = [
        event["node"].rpartition("/")[2] if event["kind"] == "node" else "open"
        for event in events
        if event.get("status") == "SUCCESS" or event.get("opening", 0.0) > ARM
    ]
    return [each for each in said if each in ("take", "lower", "open", "let go")] == ["take", "lower", "open", "let go"]
