"""What an axis's or an arm's set must bring: its columns in SI, and the model they are compared with."""

from __future__ import annotations

import numpy as np

from ..errors import GapError
from ..measurement import SHOWN, Episode, MeasurementSet, require_columns
from .arm_model import GRAVITY, ArmModel
from .axis_model import AxisModel
from .log import JointColumns
from .rigid import RigidModel
from .robot_files import find_urdf

WRONG_UNIT = 20.0  # numbers this many times too large or too small are in another unit
STRONGEST_GRAVITY = 1e3  # [m/s^2]
PAUSES = 20.0  # over what its rows take one after the other, from which on a log is not one log
LIKE = 0.9  # correlation from which on a speed column is the slope of the position


def columns_of(measured: MeasurementSet) -> JointColumns:
    """Which columns hold position, velocity and load, checked in every episode.

    Raises:
        GapError: one is missing, or its numbers cannot be in the unit the format asks for.
    """
    if measured.system == "axis":
        names = JointColumns(q=("q",), dq=("dq",), load=("force",))
    else:
        first = measured.episodes[0].columns
        n = 0
        while f"q{n + 1}" in first:
            n += 1
        if n == 0:
            require_columns(measured.episodes[0], ["q1"])
        names = JointColumns(
            q=tuple(f"q{i + 1}" for i in range(n)),
            dq=tuple(f"dq{i + 1}" for i in range(n)),
            load=tuple(f"tau{i + 1}" for i in range(n)),
        )
    for episode in measured.episodes:
        require_columns(episode, [*names.q, *names.load])
        step = float(np.median(np.diff(episode.t)))
        if step > 0.5:
            raise GapError(f"{episode.file}: column 't' steps by {step:g}, it must be in seconds (row 3)")
        if episode.t[-1] - episode.t[0] > PAUSES * step * len(episode.t):
            row = int(np.argmax(np.diff(episode.t)))
            raise GapError(
                f"{episode.file}: column 't', row {row + 3} jumps by {episode.t[row + 1] - episode.t[row]:.4g} s where "
                f"rows are {step:.4g} s apart, give what is before and after as two episodes"
            )
        for name in names.q:
            x = episode.columns[name]
            row = int(np.argmax(np.abs(x)))
            if np.abs(x[row]) > (50.0 if measured.system == "axis" else 40.0):
                unit = "metres" if measured.system == "axis" else "radians"
                raise GapError(f"{episode.file}: column '{name}', row {row + 2} is {x[row]:g}, it must be in {unit}")
            if np.ptp(x) == 0 and len(names.q) == 1:
                raise GapError(
                    f"{episode.file}: column '{name}' never changes (rows 2 to {len(x) + 1}), nothing can be learnt"
                )
        _check_speed(episode, names, "metres" if measured.system == "axis" else "radians")
    return names


def _check_speed(episode: Episode, names: JointColumns, unit: str) -> None:
    """Refuse a speed that is the slope of the position in another unit."""
    for q, dq in zip(names.q, names.dq, strict=True):
        if dq not in episode.columns:
            continue
        slope, speed = np.gradient(episode.columns[q], episode.t), episode.columns[dq]
        if slope.std() == 0 or speed.std() == 0 or np.corrcoef(slope, speed)[0, 1] < LIKE:
            continue
        ratio = float(speed.std() / slope.std())
        if not 1.0 / WRONG_UNIT < ratio < WRONG_UNIT:
            row = int(np.argmax(np.abs(speed)))
            raise GapError(
                f"{episode.file}: column '{dq}', row {row + 2} is {speed[row]:.4g}, the column is {ratio:.3g} times "
                f"the slope of '{q}', it must be in {unit} per second"
            )


def check_load(measured: MeasurementSet, names: JointColumns, model: RigidModel) -> None:
    """Refuse loads no joint of this robot can have."""
    unit = "N" if measured.system == "axis" else "N m"
    for episode in measured.episodes:
        for name, most in zip(names.load, model.strongest, strict=True):
            x = episode.columns[name]
            row = int(np.argmax(np.abs(x)))
            if abs(x[row]) > WRONG_UNIT * most:
                raise GapError(
                    f"{episode.file}: column '{name}', row {row + 2} is {x[row]:.4g}, it must be in {unit} "
                    f"(this joint is made for {most:.3g})"
                )


def rigid_model(measured: MeasurementSet, joints: int) -> RigidModel:
    """The model the set names.

    Raises:
        GapError: no such robot, or it has fewer joints than the columns.
    """
    if measured.system == "axis":
        return AxisModel(measured.number("mass"))
    robot = measured.settings.get("robot")
    file = measured.folder / "measurement.yaml"
    if not isinstance(robot, str) or not robot:
        raise GapError(f"{file}: `robot` is {robot!r}, an arm needs a URDF file or a name such as ur10 or panda")
    try:
        gravity = measured.settings.get("gravity", GRAVITY)
        if not (
            isinstance(gravity, list | tuple)
            and len(gravity) == 3
            and all(isinstance(g, int | float) and abs(g) < STRONGEST_GRAVITY for g in gravity)
        ):
            raise GapError(f"gravity is {str(gravity)[:SHOWN]}, three numbers [m/s^2] are needed")
        return ArmModel.from_urdf(
            find_urdf(robot, measured.folder), joints, (float(gravity[0]), float(gravity[1]), float(gravity[2]))
        )
    except GapError as error:
        raise GapError(f"{file}: {error}") from None
