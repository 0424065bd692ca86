"""The fingers of both hands: what a command, a squeeze, or what is between them makes of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..robot.body import JointReading, RobotBody
from ..world import SIDES, Command, GripperOpening
from .cloth import ClothBody
from .grip import CLOSED, REOPENED, Grip, held_vertices

UNASKED_FORCE = 30.0  # of fingers that nobody has told how hard to close [N]
WIDER = 0.004  # a command to open by so much more than what is held lets go of it [m]


class Fingers:
    """Keeps both grips in step with the robot's fingers.

    Args:
        grips: of the left and the right hand.
    """

    def __init__(self, grips: Sequence[Grip]) -> None:
        self.grips = list(grips)
        self._force_limit = np.full(len(self.grips), UNASKED_FORCE)
        self._told = np.zeros(len(self.grips))  # opening [m], which what they hold may keep them from
        self._kept_apart = [False] * len(self.grips)  # by an arm or an object, the last time they were looked at

    def holding(self) -> list[int]:
        """Hands that hold something."""
        return [n for n, grip in enumerate(self.grips) if grip.kind != "nothing"]

    def held(self) -> dict[int, set[int]]:
        """Body of each cloth that hands hold -> its vertices in them."""
        return held_vertices(self.grips)

    def felt(self, force: np.ndarray) -> np.ndarray:
        """What the fingers' sensors say (2,) [N]: round an arm or an object they press as hard as they were told."""
        felt = force.copy()
        for n, grip in enumerate(self.grips):
            if grip.kind in ("arm", "object"):
                felt[n] = self._force_limit[n]
        return felt

    def obey(self, command: GripperOpening, robot: RobotBody) -> Command:
        """Open or close a hand's fingers, no farther than what is between them lets them; returns what was sent."""
        n = SIDES.index(command.side)
        grip = self.grips[n]
        self._force_limit[n], self._told[n] = command.force_limit, command.opening
        grip.on_command(command.opening, float(robot.read().gripper_opening[n]))
        if grip.kind in ("arm", "object") and command.opening > grip.thickness + WIDER:
            grip.release()
        if grip.kind in ("arm", "object") and command.opening < grip.thickness:
            command = GripperOpening(side=command.side, opening=grip.thickness, force_limit=command.force_limit)
        return robot.command(command)

    def watch(self, cloth: ClothBody, vertices: np.ndarray) -> None:
        """Feel the loads, and lose what is pulled out; `vertices` (V, 3) of `cloth` count where a hand holds it."""
        for grip, limit in zip(self.grips, self._force_limit, strict=True):
            grip.watch(vertices if grip.cloth is cloth else grip.cloth.vertices(), float(limit))

    def meet(
        self,
        robot: RobotBody,
        reading: JointReading,
        hands: np.ndarray,
        squeeze: np.ndarray,
        cloths: Sequence[ClothBody],
        catches: Callable[[Grip, np.ndarray, float, float], bool],
    ) -> bool:
        """Let closed fingers take, opened ones release and squeezed ones stall; tells whether one took something.

        What was between them and has slid out leaves them to close as far as they were told.

        Args:
            robot: whose fingers they are.
            reading: of its joints now.
            hands: (2, 4, 4) their poses in the map.
            squeeze: (2,) force with which the fingers press the person [N].
            cloths: that can be taken.
            catches: whether a grip at a pose (4, 4), fingers so far apart [m] and so strong [N], takes what is rigid.
        """
        took = False
        for n, grip in enumerate(self.grips):
            opening, force = float(reading.gripper_opening[n]), float(self._force_limit[n])
            if self._kept_apart[n] and grip.kind == "nothing" and self._told[n] < opening:
                robot.command(GripperOpening(side=SIDES[n], opening=float(self._told[n]), force_limit=force))
            self._kept_apart[n] = grip.kind in ("arm", "object")
            if grip.kind == "cloth" and opening > REOPENED:
                grip.release()
            elif grip.kind == "nothing" and catches(grip, hands[n], opening, force):
                robot.command(GripperOpening(side=SIDES[n], opening=grip.thickness, force_limit=force))
                took = True
            elif squeeze[n] > force and robot.servo.gripper_opening[n] < opening:  # the fingers stall
                robot.command(GripperOpening(side=SIDES[n], opening=opening, force_limit=force))
            elif grip.kind == "nothing" and opening < CLOSED:
                grip.take_any_cloth(cloths, hands[n])
                took = took or grip.kind == "cloth"
        return took
