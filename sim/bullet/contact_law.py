"""How hard the person is where the robot touches: the force of every overlap of two capsules.

    normal   stiffness * depth + damping * closing speed, never pulling
    across   a spring that sliding stretches, with the same damper, at most friction * normal

Stiffness is the body's own (ISO/TS 15066).  A force is computed from where things are and then acts for one step, so
it is stable only while it does not throw either partner back further than it came.  The least effective mass of the
lighter partner over its step therefore bounds damping and friction, and for the arms the stiffness: of the six
segments only the hands are made softer by that (17 of 75 kN/m for a person of 18 kg, whose hand weighs 126 g).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..quantity import Quantities, quantity
from ..scene.person_spec import ARM_SEGMENTS, PERSON_PARTS
from .contact_pairs import Overlaps

_ISO = "standard: ISO/TS 15066:2016, table A.3, effective spring constant of"


@dataclass(frozen=True, kw_only=True)
class ContactTuning(Quantities):
    """How hard the person is, and what keeps an explicit force stable."""

    head: float = quantity(75e3, "N/m", "of head and neck", f"{_ISO} the face; skull 150, neck 50 N/mm")
    trunk: float = quantity(25e3, "N/m", "of the trunk", f"{_ISO} chest and pelvis; abdomen 10, back 35 N/mm")
    legs: float = quantity(50e3, "N/m", "of the legs", f"{_ISO} thighs and knees; lower legs 60 N/mm")
    upper_arm: float = quantity(30e3, "N/m", "of the upper arm", f"{_ISO} upper arms and elbows")
    forearm: float = quantity(40e3, "N/m", "of the forearm", f"{_ISO} lower arms and wrists")
    hand: float = quantity(75e3, "N/m", "of the hand", f"{_ISO} hands and fingers")
    friction: float = quantity(0.5, "1", "between robot and skin or gown", "choice: as skin on cloth, not measured")
    robot_mass: float = quantity(
        0.6,
        "kg",
        "least effective mass of a link of the robot, at a fingertip",
        "measured: inverse inertia in 300 random postures, 0.64 kg",
    )
    arm_masses: tuple[float, float, float] = quantity(
        (0.35, 0.38, 0.12),
        "1",
        "least effective mass of upper arm, forearm and hand, in masses of the arm",
        "measured: inverse inertia at the segments' ends in 400 random postures",
    )
    damping: float = quantity(
        0.4, "1", "share of the lighter one's speed that a step's damping takes", "measured: hands that hit arms"
    )
    grip: float = quantity(
        0.2, "1", "stiffness of friction, in masses of the lighter one over its squared step", "choice: no faster"
    )


TUNING = ContactTuning()


class ContactLaw:
    """The forces, and what they remember: stretched friction, and depth that is forgiven.

    Args:
        bodies: (r,) int, the same for capsules of the robot that are one rigid body.
        parts: (p,) index in `PERSON_PARTS` of the person's capsules.
        arm_mass: of one arm [kg].
        robot_step: of the robot's physics [s].
        arm_step: of the arms' physics [s].
        tuning: its numbers.
    """

    def __init__(
        self,
        bodies: np.ndarray,
        parts: np.ndarray,
        arm_mass: float,
        robot_step: float,
        arm_step: float,
        tuning: ContactTuning = TUNING,
    ) -> None:
        self._bodies, self._parts, self._tuning = bodies, parts, tuning
        names = [PERSON_PARTS[part].removeprefix("left_").removeprefix("right_") for part in parts]
        mass, step = np.full(len(names), tuning.robot_mass), np.full(len(names), robot_step)
        stiffness = np.array([getattr(tuning, name) for name in names])
        for n, name in enumerate(names):
            if name in ARM_SEGMENTS:
                mass[n], step[n] = tuning.arm_masses[ARM_SEGMENTS.index(name)] * arm_mass, arm_step
                stiffness[n] = min(stiffness[n], mass[n] / arm_step**2)
        self.stiffness = stiffness  # (p,) of each capsule of the person [N/m]
        self._damping, self._across = tuning.damping * mass / step, tuning.grip * mass / step**2
        self._stretch = np.zeros((len(bodies), len(parts), 3))
        self._forgiven = np.zeros((len(bodies), len(parts)))  # depth that pushes nothing [m]

    def forces(self, found: Overlaps, span: float) -> np.ndarray:
        """(n, 3) force of each overlap on the robot [N].

        Overlaps of one rigid body with one part share that part's stiffness by their depth: a palm made of two
        capsules is not twice as hard.

        Args:
            found: the n overlaps.
            span: since the last call [s].
        """
        pair = (found.robot, found.person)
        forgiven = np.minimum(found.depth, self._forgiven[pair])
        depth = found.depth - forgiven
        group = self._bodies[found.robot] * len(PERSON_PARTS) + self._parts[found.person]
        share = depth / np.maximum(np.bincount(group, weights=depth)[group], 1e-12)
        leaving = np.einsum("nk,nk->n", found.speed, found.normal)
        push = share * (self.stiffness[found.person] * depth - self._damping[found.person] * leaving)
        push = np.maximum(push, 0.0)
        sliding = found.speed - leaving[:, None] * found.normal
        stretch = self._stretch[pair] + span * sliding
        stretch -= np.einsum("nk,nk->n", stretch, found.normal)[:, None] * found.normal
        across, damping = (share * values[found.person] for values in (self._across, self._damping))
        pull = -across[:, None] * stretch - damping[:, None] * sliding
        most = self._tuning.friction * push
        size = np.linalg.norm(pull, axis=1)
        slips = size > most
        pull[slips] *= (most[slips] / size[slips])[:, None]
        stretch[slips] = -pull[slips] / np.maximum(across[slips], 1e-9)[:, None]
        self.forget()
        self._stretch[pair], self._forgiven[pair] = stretch, forgiven
        return push[:, None] * found.normal + pull

    def forgive(self, pairs: np.ndarray) -> None:
        """What overlaps of `pairs` (r, p) bool is not pushed apart at once: only what goes deeper, until they part."""
        self._forgiven[pairs] = np.inf

    def forget(self) -> None:
        """Nothing touches."""
        self._stretch[:], self._forgiven[:] = 0.0, 0.0
