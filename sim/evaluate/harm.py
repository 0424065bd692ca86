"""Was the person harmed, or left as no nurse would leave a person?"""

from __future__ import annotations

import numpy as np

from ..world import SIDES
from . import limits
from .clearance import ArmMotion, clearance
from .coverage import layers
from .face import face_covered
from .findings import Findings
from .truth_file import Truth
from .unharmed_rows import UnharmedRows


def find_harm(truth: Truth, rows: UnharmedRows, outside_out: float) -> Findings:
    """Problems and numbers of the person's own; no problem means unharmed.

    Args:
        truth: of the run.
        rows: `truth.unharmed`.
        outside_out: part of the covered torso with the outside of the gown out.
    """
    found = Findings()
    look_at_wrists(truth, rows, found)
    look_at_robot(truth, rows, found)
    _look_at_face(truth, rows, found)
    _look_at_gown(truth, rows, outside_out, found)
    look_at_forces(truth, rows, found)
    return found


def wrists_above_bed(truth: ArmMotion, rows: UnharmedRows) -> np.ndarray:
    """(T, 2) height of the left and right wrist above the mattress [m]."""
    return truth.arms[:, :, 2, 2].astype(np.float64) - rows.bed_top


def look_at_wrists(truth: ArmMotion, rows: UnharmedRows, found: Findings) -> None:
    """Do both arms lie in the end?"""
    held = truth.t >= truth.t[-1] - limits.HOLD
    for side, high in zip(SIDES, wrists_above_bed(truth, rows)[held].max(axis=0), strict=True):
        found.numbers[f"wrist_{side}_above_bed_m"] = float(high)
        if high > limits.WRIST_ABOVE_BED_MAX:
            found.problems.append(
                f"the {side} wrist ends {high:.3f} m above the mattress, {limits.WRIST_ABOVE_BED_MAX} m are allowed: "
                "the arm does not lie"
            )


def look_at_robot(truth: ArmMotion, rows: UnharmedRows, found: Findings) -> None:
    """Is a link of the robot inside the person at any time?"""
    near = clearance(truth, rows)
    for name, parts, allowed in (
        ("robot_depth_head_m", near.head, limits.ROBOT_DEPTH_HEAD_MAX),
        ("robot_depth_elsewhere_m", ~near.head, limits.ROBOT_DEPTH_MAX),
    ):
        gap, frame, link, part = near.nearest(parts)
        depth = found.numbers[name] = max(0.0, -gap)
        if depth > 0:
            found.places[name] = f"{_spoken(link)} of the robot in the {_spoken(part)}, {truth.t[frame]:.1f} s"
        if depth > allowed:
            found.problems.append(
                f"the {_spoken(link)} of the robot is {1000 * depth:.1f} mm inside the person's {_spoken(part)} at "
                f"{truth.t[frame]:.1f} s, {1000 * allowed:g} mm are allowed"
            )


def _look_at_face(truth: Truth, rows: UnharmedRows, found: Findings) -> None:
    covered, until = face_covered(truth.t, truth.vertices, truth.faces, rows.face)
    found.numbers["face_covered_s"] = covered
    if covered:
        found.places["face_covered_s"] = f"until {until:.1f} s"
    if covered > limits.FACE_COVERED_MAX:
        found.problems.append(
            f"cloth lies on the face for {covered:.2f} s until {until:.1f} s, {limits.FACE_COVERED_MAX:g} s is allowed"
        )


def _look_at_gown(truth: Truth, rows: UnharmedRows, outside_out: float, found: Findings) -> None:
    """How the gown lies at the end."""
    vertices = truth.vertices[-1].astype(np.float64)
    over = layers(vertices, truth.faces, truth.torso_front[-1].astype(np.float64))
    many = found.numbers["three_layers"] = float(np.mean(over >= limits.LAYERS_MANY)) if len(over) else 0.0
    if many > limits.LAYERS_SHARE_MAX:
        found.problems.append(
            f"three and more layers lie on {many:.2f} of the torso front, {limits.LAYERS_SHARE_MAX} is allowed"
        )
    if outside_out < limits.OUTSIDE_NEAT_MIN:
        found.problems.append(
            f"the outside is out on {outside_out:.2f} of the covered torso, {limits.OUTSIDE_NEAT_MIN} is asked for"
        )
    middle = vertices[rows.neckline[len(rows.neckline) // 2]] - truth.arms[-1, :, 0].astype(np.float64).mean(axis=0)
    aside, along = float(middle[0]), float(middle[1])  # map frame: x to the person's right, y to the feet
    found.numbers |= {"neckline_along_m": along, "neckline_aside_m": aside}
    low, high = limits.COLLAR_ALONG
    if not low <= along <= high:
        found.problems.append(
            f"the middle of the neckline lies {along:.3f} m from the shoulders towards the feet, {low} m to {high} m "
            "are allowed"
        )
    if abs(aside) > limits.COLLAR_ASIDE_MAX:
        found.problems.append(
            f"the middle of the neckline lies {abs(aside):.3f} m beside the middle of the shoulders, "
            f"{limits.COLLAR_ASIDE_MAX} m are allowed"
        )


def look_at_forces(truth: ArmMotion, rows: UnharmedRows, found: Findings) -> None:
    """Is a part of the body pressed harder than it may be at any time?"""
    force = np.nan_to_num(rows.person_force.astype(np.float64), nan=0.0, posinf=np.inf)  # NaN: not measured
    for k, part in enumerate(rows.person_parts):
        name = f"force_{part}_n"
        frame = int(force[:, k].argmax())
        peak = found.numbers[name] = float(force[frame, k])
        found.places[name] = f"{truth.t[frame]:.1f} s"
        limit = limits.force_limit(part)
        if limit is not None and peak > limit:
            found.problems.append(
                f"the force on the {_spoken(part)} reaches {peak:.0f} N at {truth.t[frame]:.1f} s, {limit:g} N are "
                "allowed"
            )


def _spoken(name: str) -> str:
    return name.replace("_", " ")
