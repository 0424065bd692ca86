"""A dressing without physics: fingers meet cloth, or an arm where one lies; the gown follows as light cloth does.

What is seen comes from a script too (`scripted_senses`).  Every grasp succeeds, so that a whole task can be rehearsed,
and every recovery and safe branch reached by injecting faults; how cloth behaves is not shown.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from ...sim.known_robots import robot_named
from ...sim.mechanics.kinematics import kinematics_of
from ...sim.mechanics.robot_model import RobotModel
from ...sim.mechanics.servo import PERIOD
from ...sim.quantity import Quantities, quantity
from ...sim.scene.initial_state import InitialState
from ...sim.scene.scene import room_map
from ...sim.scripted.world import STEP, ScriptedWorld
from ...sim.vector import length
from ...sim.world import SIDES, Command, GripperOpening, Observation, Side
from .scripted_person import lying_arm
from .scripted_senses import ScriptedSenses


@dataclass(frozen=True, kw_only=True)
class RehearsalTuning(Quantities):
    """What hands meet in a rehearsal."""

    closing_opening: float = quantity(
        0.03, "m", "between the fingertips, below which a hand takes hold", "choice: no skill goes in with less"
    )
    arm_radius: float = quantity(
        0.05, "m", "about an arm's axis, within which closing fingers hold the arm", "choice: that of an upper arm"
    )
    arm_width: float = quantity(0.07, "m", "of an arm between the fingers", "choice: a forearm")
    cloth_width: float = quantity(0.002, "m", "of cloth between the fingers", "choice: two layers and a hem")
    hanging_load: float = quantity(1.4, "N", "of what hangs on a hand", "choice: two hands carry a light gown")
    tick_rate: float = quantity(
        3.0,
        "Hz",
        "ticks a second that suffice where nobody injects faults",
        "measured: shipped tasks end alike from 3 to 15; at 2.6 pulls that wait count as stalled, at 1.9 time limits "
        "are missed",
    )
    steps: int = quantity(4, "1", "of the integration from tick to tick, at most", "choice: as at the usual 15 ticks")
    twist_steps: int = quantity(
        7, "1", "in which a hand follows a twist from tick to tick, at most", "choice: as at the usual 15 ticks"
    )
    stiffness: float = quantity(100.0, "N/m", "with which cloth holds a hand back", "choice: felt within centimetres")
    max_drag: float = quantity(
        1.1, "N", "with which cloth holds a hand back at most", "choice: below the loads at which skills stop"
    )


REHEARSAL = RehearsalTuning()


class RehearsalWorld(ScriptedWorld):
    """The scripted world in the map of the simulated room, with something to hold wherever a hand closes.

    Args:
        seed: of the sensor noise.
        robot: that is rehearsed with; the usual one by default.
        tuning: what the hands meet.

    Attributes:
        initial_states: names of the states in which a run may begin.
        initial_state: that in which this one began.
        tick_rate: ticks a second that suffice: nothing happens between two of them.
    """

    initial_states = tuple(InitialState)

    def __init__(self, seed: int = 0, *, robot: RobotModel | None = None, tuning: RehearsalTuning = REHEARSAL) -> None:
        robot = robot or robot_named()
        super().__init__(
            seed=seed,
            room=room_map(),
            robot=robot,
            kinematics=kinematics_of(robot),
            arm_positions=robot.ready,
        )
        self._tuning = tuning
        self.initial_state = InitialState.GOWN_ON_HOOK
        self.tick_rate = tuning.tick_rate
        self._taken: dict[Side, np.ndarray] = {}  # where a hand has taken hold [m]
        self._sample: Observation | None = None  # of this instant

    def set_initial_state(self, name: str) -> None:
        """Begin with the gown in both hands, or with empty ones wherever else it is said to be.

        Raises:
            WorldError: there is no such state.
        """
        self.initial_state = InitialState.named(name)
        if self.initial_state == InitialState.GOWN_IN_HANDS:
            self._opening[:] = self._tuning.cloth_width
            for side in SIDES:
                self.send(GripperOpening(side=side, opening=0.0))

    def send(self, command: Command) -> Command:
        """Start a command; a closing hand finds something, an opening one loses it."""
        if isinstance(command, GripperOpening):
            if command.opening >= self._tuning.closing_opening:
                self._taken.pop(command.side, None)
                self.between_fingers[command.side] = 0.0
            elif command.side not in self._taken:
                hand = self._taken[command.side] = self._hand(command.side)
                arms = [lying_arm(side) + self.person_offset for side in SIDES]
                away = min(_distance(hand, *limb) for arm in arms for limb in itertools.pairwise(arm))
                met = self._tuning.arm_width if away < self._tuning.arm_radius else self._tuning.cloth_width
                self.between_fingers[command.side] = met
        self._sample = None
        return super().send(command)

    def stop(self) -> None:
        """End every motion."""
        self._sample = None
        super().stop()

    def observe(self) -> Observation:
        """The scripted world's senses, with the load of what the hands hold.

        They sample once an instant: guard and skills ask four times a tick, and are told the same, noise included,
        until time has passed or a command was sent.
        """
        if self._sample is None or self._sample.time < self.time.time:
            for side in SIDES:
                self.load[side] = np.zeros(6)
                if side in self._taken and self.between_fingers[side] > 0.0:
                    self.load[side][:3] = self.held_back(side)
            self._sample = super().observe()
        return self._sample

    def _advance_to(self, time: float) -> None:
        ahead = time - self.time.time
        self._longest_step = max(STEP, ahead / self._tuning.steps)
        self._twist_step = max(PERIOD, ahead / self._tuning.twist_steps)
        if self._follows_until(time):
            self._leap(time)
        super()._advance_to(time)

    def _leap(self, time: float) -> None:
        """Begin the last step before a time: where trajectories lead the clock alone says, that step says how fast."""
        now = self.time.time
        while (then := now + min(self._longest_step, time - now)) < time - 1e-9:
            now = then
        if now > self.time.time:
            self._step(now - self.time.time)
            self.time.time = now  # without the rounding of the sum

    def _follows_until(self, time: float) -> bool:
        """Whether trajectories that last until then move the arms, and nothing else moves."""
        now = self.time.time
        if not self._motions or self._twisting() or self._rates or now < self._base_until or self._slowing(now) > 0.0:
            return False
        lasting = all(time - motion.start <= motion.times[-1] for motion in self._motions)
        return lasting and self._opening.tolist() == self._fingers_goal()

    def held_back(self, side: Side) -> np.ndarray:
        """Force (3,) in the map on a hand by what it holds [N]; a task whose things do otherwise says so here."""
        drag = self._tuning.stiffness * (self._taken[side] - self._hand(side))
        drag = drag * min(1.0, self._tuning.max_drag / max(length(drag), 1e-9))
        return drag - (0.0, 0.0, self._tuning.hanging_load)

    def _hand(self, side: Side) -> np.ndarray:
        return self._hand_poses()[SIDES.index(side), :3, 3].copy()


def _distance(point: np.ndarray, start: np.ndarray, end: np.ndarray) -> float:
    """Of a point from a segment [m]."""
    along = end - start
    share = np.clip((point - start) @ along / (along @ along), 0.0, 1.0)
    return float(np.linalg.norm(start + share * along - point))


def rehearsal(seed: int, robot: RobotModel | None = None) -> tuple[RehearsalWorld, ScriptedSenses]:
    """A world to rehearse a task on, with the usual robot or another, and what is seen there."""
    world = RehearsalWorld(seed, robot=robot)
    return world, ScriptedSenses(world)
