"""A serial arm predicted by pinocchio from a URDF."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ....sim.effects.effect import Parameter
from ....sim.effects.joint.arm_geometry import BASE, GEOMETRY, ZERO, tilt_changes, tilts, with_tilted_base
from ....sim.effects.joint.link_inertia import with_point_mass, with_scaled_mass
from ..errors import GapError
from .rigid import BodyTerm, RigidModel

GRAVITY = (0.0, 0.0, -9.81)
MOTIONS_KEPT = 8  # of which the regressor is remembered
MOMENTS = tuple(Parameter(name=f"mass_com_{a}", unit="kg m") for a in "xyz")
SMALL = 1e-5  # an angle at which loads are straight in it [rad]
MASS_DEVIATION = 0.1  # a link mass in a URDF is usually right to a tenth


class ArmModel(RigidModel):
    """Inverse dynamics by the recursive Newton-Euler algorithm, forward by the articulated-body algorithm.

    Args:
        urdf: where the model was read from.
        model: pinocchio's model of the measured joints.
        tool: pinocchio's inertia of what is fixed to the last link, None where nothing is.
        zeros: (n,) what each joint's reading lacks [rad]; None for nothing.
    """

    def __init__(self, urdf: Path, model: Any, tool: Any, zeros: np.ndarray | None = None) -> None:
        import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

        self._pin = pin
        self.urdf, self.model, self.tool = urdf, model, tool
        self._zeros = np.zeros(model.njoints - 1) if zeros is None else zeros
        self.data = model.createData()
        self.joints = tuple(model.names[1:])
        self.prismatic = tuple("P" in model.joints[i].shortname()[10:12] for i in range(1, model.njoints))
        self._kept: dict[tuple[bytes, ...], np.ndarray] = {}
        self._round = [model.joints[i].nq == 2 for i in range(1, model.njoints)]

    @classmethod
    def from_urdf(cls, urdf: Path, joints: int, gravity: tuple[float, float, float] = GRAVITY) -> ArmModel:
        """Read the model and lock every joint beyond the first `joints` movable ones.

        Args:
            urdf: file.
            joints: how many are measured.
            gravity: acceleration in the base frame [m/s^2].

        Raises:
            GapError: the URDF cannot be read or has fewer movable joints.
        """
        import pinocchio as pin  # pyright: ignore[reportMissingImports] - lives in a cmeel prefix

        try:
            full = pin.buildModelFromUrdf(str(urdf))
        except Exception as error:  # pinocchio raises several kinds
            raise GapError(f"{urdf}: not a URDF that pinocchio can read ({str(error).splitlines()[0]})") from None
        movable = [i for i in range(1, full.njoints) if full.joints[i].nv == 1]
        if not movable:
            raise GapError(f"{urdf}: has no joint that moves, an arm needs one at least")
        if len(movable) < joints:
            raise GapError(f"{urdf}: has {len(movable)} movable joints, the columns name {joints}")
        joint_names = set(full.names)
        for frame in full.frames:  # a link named as a joint is one name too many for pinocchio's reduction
            if frame.type == pin.FrameType.BODY and frame.name in joint_names:
                frame.name = f"{frame.name} (link)"
        tool = None
        for frame in full.frames:  # bodies fixed to the last measured link keep their own inertia as frames
            if frame.parentJoint == movable[joints - 1] and frame.inertia.mass > 1e-6:
                part = frame.placement.act(frame.inertia)
                tool = part if tool is None else tool + part
        lock = [i for i in range(1, full.njoints) if i not in movable[:joints]]
        model = pin.buildReducedModel(full, lock, pin.neutral(full)) if lock else full
        model.gravity.linear = np.asarray(gravity, dtype=float)
        return cls(urdf, model, tool)

    @property
    def strongest(self) -> tuple[float, ...]:
        """Effort limits of the URDF [N m]."""
        return tuple(float(x) if x > 0 else float("inf") for x in self.model.effortLimit)

    def configuration(self, q: np.ndarray) -> np.ndarray:
        """Pinocchio's configuration of joint angles as read (n,): continuous joints become cosine and sine."""
        q = q + self._zeros
        if not any(self._round):
            return np.ascontiguousarray(q)
        out = []
        for angle, turning in zip(q, self._round, strict=True):
            out += [np.cos(angle), np.sin(angle)] if turning else [angle]
        return np.array(out)

    def load(self, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Joint torques along a motion, (T, n) [N m]."""
        pin, model, data = self._pin, self.model, self.data
        return np.array(
            [pin.rnea(model, data, self.configuration(a), b, c) for a, b, c in zip(q, dq, ddq, strict=True)]
        )

    def acceleration(self, q: np.ndarray, dq: np.ndarray, load: np.ndarray) -> np.ndarray:
        """Joint acceleration at one instant, (n,) [rad/s^2]."""
        return self._pin.aba(self.model, self.data, self.configuration(q), dq, load)

    def tip(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position (3,) [m] of the last link's centre of mass in the base frame and its Jacobian (3, n)."""
        pin, model, data = self._pin, self.model, self.data
        last = model.njoints - 1
        jac = pin.computeJointJacobian(model, data, self.configuration(q), last)
        spin, lever = data.oMi[last].rotation, model.inertias[last].lever
        return data.oMi[last].act(lever), spin @ (jac[:3] - pin.skew(lever) @ jac[3:])

    def body_terms(self) -> list[BodyTerm]:
        """Link masses (the model's own numbers), a payload and a wrong tool on the last link."""
        n = self.model.njoints
        terms = [
            BodyTerm(
                name="mass",
                target=self.model.names[i],
                recalibration=True,
                shape={},
                deviation=MASS_DEVIATION * self.model.inertias[i].mass,
                parameters=(Parameter(name="mass", unit="kg", lower=-self.model.inertias[i].mass),),
            )
            for i in range(1, n - 1)
            if self.model.inertias[i].mass > 1e-3
        ]
        last = self.model.names[n - 1]
        terms.append(self.payload)
        if self.tool is not None:
            terms.append(
                BodyTerm(
                    name="wrong_tool",
                    target=last,
                    recalibration=False,
                    shape={},
                    parameters=(Parameter(name="mass", unit="kg", lower=-self.tool.mass),),
                )
            )
        else:
            terms.append(
                BodyTerm(
                    name="wrong_tool",
                    target=last,
                    recalibration=False,
                    shape={},
                    parameters=(
                        Parameter(name="mass", unit="kg", lower=-self.model.inertias[n - 1].mass, upper=0.0),
                        *MOMENTS,
                    ),
                )
            )
        return terms

    def geometry_terms(self) -> list[BodyTerm]:
        """How the base may stand, and where the zeros of turning joints may be; gravity alone shows either."""
        gravity = np.asarray(self.model.gravity.linear)
        if not gravity.any():
            return []
        zeros = [
            BodyTerm(name="encoder_offset", target=joint, recalibration=False, shape={}, parameters=(ZERO,))
            for joint, slides in zip(self.joints, self.prismatic, strict=True)
            if not slides
        ]
        tilt = BodyTerm(name="base_tilt", target=BASE, recalibration=False, shape={}, parameters=tilts(gravity))
        return [tilt, *zeros]

    @property
    def payload(self) -> BodyTerm:
        """A point mass on the last link, at a centre of its own."""
        return BodyTerm(
            name="payload",
            target=self.model.names[self.model.njoints - 1],
            recalibration=False,
            shape={},
            parameters=(Parameter(name="mass", unit="kg", lower=0.0), *MOMENTS),
        )

    def body_columns(self, term: BodyTerm, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Torque per unit of each parameter, (T, n, p).

        Payload inertia about its own centre is neglected; `shape` may carry the centre (com_x, com_y, com_z) [m] at
        which the point mass is taken, so that its inertia about the joint axes is not.
        """
        pin, model = self._pin, self.model
        if term.name == "base_tilt":
            return self._tilt_columns(term, q)
        if term.name == "encoder_offset":
            return self._zero_columns(term, q, dq, ddq)
        index = model.getJointId(term.target)
        if term.name == "mass":
            inertia = model.inertias[index]
            mix = inertia.toDynamicParameters()[:, None] / inertia.mass
        elif term.name == "wrong_tool" and self.tool is not None:
            mix = self.tool.toDynamicParameters()[:, None] / self.tool.mass
        else:
            mix = np.zeros((10, 4))
            mix[:4] = np.eye(4)
            if term.shape:
                c = np.array([term.shape[f"com_{a}"] for a in "xyz"])
                point = pin.Inertia(1.0, c, np.zeros((3, 3))).toDynamicParameters()
                mix[4:, 0] = point[4:]
        return self.inertial_columns(term.target, q, dq, ddq) @ mix

    def _tilt_columns(self, term: BodyTerm, q: np.ndarray) -> np.ndarray:
        """Torque of gravity per turn of the base about each axis, exact at the term's own turn, (T, n, p)."""
        pin, out = self._pin, []
        names = [p.name for p in term.parameters]
        at = {name: term.shape.get(name, 0.0) for name in names}
        for change in tilt_changes(np.asarray(self.model.gravity.linear), names, at):
            turned = self.model.copy()
            turned.gravity.linear = change
            data = turned.createData()
            out.append(np.array([pin.computeGeneralizedGravity(turned, data, self.configuration(a)) for a in q]))
        return np.stack(out, axis=2)

    def _zero_columns(self, term: BodyTerm, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Torque per angle that one joint's reading lacks, exact at the term's own angle, (T, n, 1)."""
        angle = term.shape.get("angle", 0.0) or SMALL
        return ((self.patched(term, {"angle": angle}).load(q, dq, ddq) - self.load(q, dq, ddq)) / angle)[:, :, None]

    def inertial_columns(self, body: str, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Torque per unit of each of a body's ten inertial parameters, (T, n, 10), in pinocchio's order."""
        index = self.model.getJointId(body)
        return self._regressor(q, dq, ddq)[:, :, 10 * (index - 1) : 10 * index]

    def _regressor(self, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """Joint loads per inertial parameter of every body along a motion, (T, n, 10 n).

        The terms of one motion ask for it one after the other, so that of the last motions is kept.
        """
        key = tuple(x.tobytes() for x in (q, dq, ddq))
        if key not in self._kept:
            while len(self._kept) >= MOTIONS_KEPT:
                del self._kept[next(iter(self._kept))]
            pin, model, data = self._pin, self.model, self.data
            self._kept[key] = np.array(
                [
                    pin.computeJointTorqueRegressor(model, data, self.configuration(a), b, c)
                    for a, b, c in zip(q, dq, ddq, strict=True)
                ]
            ).reshape(*q.shape, -1)  # of one joint pinocchio gives a row, not a matrix
        return self._kept[key]

    def patched(self, term: BodyTerm, values: dict[str, float]) -> ArmModel:
        """The arm with a body changed by `values`."""
        model, zeros = self.model, self._zeros
        if term.name == "mass":
            model = with_scaled_mass(model, term.target, values["mass"])
        elif term.name == "base_tilt":
            model = with_tilted_base(model, values)
        elif term.name == "encoder_offset":
            zeros = zeros + values["angle"] * (np.array(self.joints) == term.target)
        else:
            model = with_point_mass(model, term.target, self.moments(term, values))
        return ArmModel(self.urdf, model, self.tool, zeros)

    def with_armature(self, joint: int, inertia: float) -> ArmModel:
        """The arm with a rotor's inertia [kg m^2] on one joint."""
        model = self.model.copy()
        armature = np.array(model.armature)
        armature[joint] += inertia
        model.armature = armature
        return ArmModel(self.urdf, model, self.tool, self._zeros)

    def moments(self, term: BodyTerm, values: dict[str, float]) -> dict[str, float]:
        """Numbers of a change as a model file has them; a scaled tool brings the URDF tool's own centre."""
        if term.name in GEOMETRY:
            return dict(values)
        if "mass_com_x" in values or self.tool is None:
            return super().moments(term, values)
        return {
            "mass": values["mass"],
            **{f"mass_com_{a}": float(values["mass"] * c) for a, c in zip("xyz", self.tool.lever, strict=True)},
        }
