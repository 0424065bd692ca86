"""A world whose left arm is simulated with friction that its model does not know of, as a robot with a dry joint is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
from caretree.sim.effects.joint.pinocchio_dynamics import EffectArm
from caretree.sim.effects.model_file import EffectEntry, EffectModel
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.clock import SteppedClock
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import Command, JointTrajectory, Observation
from scipy.interpolate import CubicSpline

STEP = 0.002  # [s]
STIFFNESS, DAMPING = 400.0, 40.0  # of the controller [1/s^2], [1/s]
EFFORT_NOISE, SPEED_NOISE = 0.05, 1e-4  # [N m], [rad/s] standard deviations
LEFT = list(BAXTER.joints_of("left"))
PERIODS = np.array((5.0, 3.1, 2.3, 1.7))  # [s] of a swing


class StickyArm(ScriptedWorld):
    """The scripted Baxter with dynamics in its left arm; the controller that drives it knows of no friction.

    Args:
        seed: of the noise.
        joint: that has the friction.
        level: of it [N m].
    """

    def __init__(self, seed: int = 0, joint: str = "left_e1", level: float = 0.0) -> None:
        super().__init__(seed=seed, arm_positions=BAXTER.ready)
        full = pin.buildModelFromXML(BAXTER.urdf())
        locked = [full.getJointId(name) for name in full.names[1:] if name not in LEFT]
        self._model = pin.buildReducedModel(full, locked, pin.neutral(full))
        self._data = self._model.createData()
        friction = (EffectEntry(name="coulomb_friction", target=joint, parameters={"level": level}),)
        self._arm = EffectArm(self._model, EffectModel(system="arm", base={}, recalibration=(), effects=friction))
        self._noise = np.random.default_rng([seed, 1])
        self._angles, self._speeds = np.array(BAXTER.ready[0]), np.zeros(7)
        self._began, self._path = 0.0, CubicSpline((0.0, 1.0), np.tile(self._angles, (2, 1)))
        self.clock = self.time = SteppedClock(self._simulate)
        self._torque = self._driven()

    def send(self, command: Command) -> Command:
        """Follow a trajectory of the whole left arm."""
        assert isinstance(command, JointTrajectory)
        self._began = self.time.time
        self._path = CubicSpline(command.times, command.positions, bc_type="clamped")
        return command

    def observe(self) -> Observation:
        """As the scripted robot, with what its left arm does and is driven with."""
        seen = super().observe()
        positions, velocities, efforts = seen.arm_positions, seen.arm_velocities, seen.arm_efforts
        positions[0] = self._angles
        velocities[0] = self._speeds + SPEED_NOISE * self._noise.standard_normal(7)
        efforts[0] = self._torque + EFFORT_NOISE * self._noise.standard_normal(7)
        return replace(seen, arm_positions=positions, arm_velocities=velocities, arm_efforts=efforts)

    def _simulate(self, until: float) -> None:
        while self.time.time < until - 1e-9:
            self._speeds = self._speeds + STEP * self._arm.forward(self._angles, self._speeds, self._torque)
            self._angles = self._angles + STEP * self._speeds
            self.time.time += STEP
            self._torque = self._driven()

    def _driven(self) -> np.ndarray:
        """Torque (7,) of the controller as the arm is [N m]."""
        at = min(self.time.time - self._began, self._path.x[-1])
        wanted = self._path(at, 2) + STIFFNESS * (self._path(at) - self._angles)
        wanted += DAMPING * (self._path(at, 1) - self._speeds)
        return pin.rnea(self._model, self._data, self._angles, self._speeds, wanted)


def swing(seed: int, duration: float = 12.0) -> JointTrajectory:
    """All joints of the left arm swing about the ready posture, each in its own way, from rest to rest."""
    rng = np.random.default_rng(seed)
    times = np.arange(0.0, duration + 1e-9, 0.05)
    ramp = np.sin(np.pi * times / duration)[:, None] ** 2
    phases = rng.uniform(0.0, 2.0 * np.pi, (len(PERIODS), 7))
    waves = sum(
        np.sin(2.0 * np.pi * times[:, None] / period + phase) for period, phase in zip(PERIODS, phases, strict=True)
    )
    return JointTrajectory(joints=tuple(LEFT), times=times, positions=BAXTER.ready[0] + 0.12 * ramp * waves)
