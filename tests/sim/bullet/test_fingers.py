"""Fingers stay apart by what they hold, and close once it has slid out."""

from types import SimpleNamespace

import numpy as np
from caretree.sim.bullet.fingers import Fingers
from caretree.sim.world import GripperOpening

THICK, WIDE = 0.07, 0.085  # [m]
NO_SQUEEZE = np.zeros(2)


class Robot:
    """Obeys at once."""

    def __init__(self):
        self.opening, self.commands = np.full(2, WIDE), []

    def command(self, command):
        self.commands.append((command.side, command.opening, command.force_limit))
        self.opening[0 if command.side == "left" else 1] = command.opening
        return command

    def read(self):
        return SimpleNamespace(gripper_opening=self.opening.copy())


def grip():
    made = SimpleNamespace(kind="nothing", thickness=0.0)
    made.on_command = lambda opening, now_open: None
    made.take_any_cloth = lambda cloths, hand: None
    made.release = lambda: setattr(made, "kind", "nothing")
    return made


def takes_an_arm(grip, hand, opening, force):
    grip.kind, grip.thickness = "arm", THICK
    return True


def meet(fingers, robot, catches=lambda *_: False):
    return fingers.meet(robot, robot.read(), np.zeros((2, 4, 4)), NO_SQUEEZE, (), catches)


def holding_an_arm():
    """The left fingers, told to close with 20 N, have an arm between them."""
    fingers, robot = Fingers([grip(), SimpleNamespace(kind="cloth")]), Robot()
    fingers.grips[1].release = lambda: None
    fingers.obey(GripperOpening(side="left", opening=0.0, force_limit=20.0), robot)
    robot.opening[0] = THICK
    assert meet(fingers, robot, takes_an_arm)
    meet(fingers, robot)
    assert robot.commands[-1] == ("left", THICK, 20.0)
    return fingers, robot


def test_fingers_close_as_far_as_they_were_told_once_an_arm_has_slid_out():
    fingers, robot = holding_an_arm()
    fingers.grips[0].kind = "nothing"
    meet(fingers, robot)
    assert robot.commands[-1] == ("left", 0.0, 20.0)
    many = len(robot.commands)
    meet(fingers, robot)
    assert len(robot.commands) == many, "told once"


def test_fingers_that_let_an_arm_go_stay_open():
    fingers, robot = holding_an_arm()
    fingers.obey(GripperOpening(side="left", opening=WIDE, force_limit=20.0), robot)
    meet(fingers, robot)
    assert robot.commands[-1][1] == WIDE
