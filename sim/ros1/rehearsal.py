"""What a tree may ask of a simulated robot beyond what robots do: to begin anew, and to play what happens in physics.

| name | kind | meaning |
|---|---|---|
| `/caretree/begin_anew` | `std_msgs/UInt32` | come back to the beginning, on a fresh world |
| `/caretree/begun` | parameter | the last number with which that was asked for, once it is done |
| `/caretree/begins_with` | parameter | the state in which that beginning is, as stages name it |
| `/caretree/grip_slip` | `std_msgs/String` | what that hand holds slides out of it |
| `/caretree/person_moves` | `std_msgs/Empty` | the person stirs |
| `/caretree/person_offset` | `geometry_msgs/Vector3` | how far a made-up person has moved by now [m] |

Nobody takes these topics on a real robot, and its faults are not played.
"""

from __future__ import annotations

import secrets
import time
from typing import Any

import numpy as np

from ..world import Side, WorldError
from .clock import parameter
from .ros import publisher, ros

BEGIN_ANEW, GRIP_SLIP, PERSON_MOVES = "/caretree/begin_anew", "/caretree/grip_slip", "/caretree/person_moves"
PERSON_OFFSET = "/caretree/person_offset"
BEGUN, BEGINS_WITH = "/caretree/begun", "/caretree/begins_with"  # parameters of the master
BUILDING = 300.0  # [s] of wall time in which a fresh simulation is there
LOOK = 0.02  # [s] between two looks whether it is


class Rehearsal:
    """The tree's end.

    Args:
        rospy: the node.

    Attributes:
        person_offset: how far (3,) a made-up person has moved [m].
    """

    def __init__(self, rospy: Any) -> None:
        there = ros()
        self.person_offset = np.zeros(3)
        kinds = {
            BEGIN_ANEW: there.std_msgs.UInt32,
            GRIP_SLIP: there.std_msgs.String,
            PERSON_MOVES: there.std_msgs.Empty,
        }
        self._asks = {topic: publisher(rospy, topic, kind, at_once=True) for topic, kind in kinds.items()}
        self._moved = rospy.Subscriber(PERSON_OFFSET, there.geometry_msgs.Vector3, self._heard)

    def begin_anew(self, patience: float) -> None:
        """Bring the robot back to its beginning.

        Args:
            patience: how long its topics may take to come [s].

        Raises:
            WorldError: it is no simulated robot, or does not come back.
        """
        number = 1 + secrets.randbelow(2**31)  # 0 is nobody's
        self._ask(BEGIN_ANEW, number, patience=patience)
        ends = time.monotonic() + BUILDING
        while parameter(BEGUN) != number:
            if time.monotonic() > ends:
                raise WorldError(f"the simulated robot has not come back to its beginning for {BUILDING:.0f} s")
            time.sleep(LOOK)

    def grip_slip(self, side: Side) -> None:
        """Let what a hand holds slide out of it; raises WorldError on a real robot."""
        self._ask(GRIP_SLIP, side)

    def move_person(self) -> None:
        """Have the person stir; raises WorldError on a real robot."""
        self._ask(PERSON_MOVES)

    def close(self) -> None:
        """Release the topics."""
        for each in (*self._asks.values(), self._moved):
            each.unregister()

    def _ask(self, topic: str, *value: Any, patience: float = 0.0) -> None:
        ends, asked = time.monotonic() + patience, self._asks[topic]
        while not asked.get_num_connections():
            if time.monotonic() >= ends:
                raise WorldError(f"nobody takes {topic}: only a simulated robot does, `caretree serve-robot`")
            time.sleep(LOOK)
        asked.publish(*value)

    def _heard(self, offset: Any) -> None:
        self.person_offset = np.array((offset.x, offset.y, offset.z))
