"""The arm as three capsules, fitted to depth points by damped least squares.

Unknowns are the four joint centres q = (shoulder, elbow, wrist, fingertip), 12 numbers.  Residuals, each divided by its
standard deviation: signed distance of every skin point to the nearest capsule's surface; every sample of the
axis that the image shows to be empty, by its distance to the nearest skin; lengths of an adult; a straight
hand; and a weak pull towards a home, which keeps what nothing observes where it was.  The inverse of the
Gauss-Newton matrix at the end is the covariance, so an unobserved joint says so itself.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.vector import cross
from ..image.cloud import unit
from ..image.projection import project
from .lying_body import Trunk
from .person_facts import PERSON
from .skin_view import SkinView


@dataclass(frozen=True, kw_only=True)
class ArmFitTuning(Quantities):
    """Numbers of the fit: how firmly each kind of evidence holds, and when the steps end."""

    # skin points
    point_deviation: float = quantity(
        0.012, "m", "of one point from the surface", "choice: sensor noise and limbs that are no capsules"
    )
    independent_points: int = quantity(
        30,
        "1",
        "of the skin points, of which neighbours share their error",
        "choice: one in ten of those that are fitted",
    )
    outlier_distance: float = quantity(
        0.03, "m", "from the surface, where a point counts half", "choice: more than twice a point's deviation"
    )
    back_cosine: float = quantity(
        -0.5,
        "1",
        "towards the camera, below which a point is on the far side of the axis",
        "choice: a camera sees no skin that faces away; noise at the rim does",
    )
    # samples of the axis that the image shows to be empty
    samples: int = quantity(6, "1", "along the axis of each limb", "choice: every 3 to 5 cm")
    first_sample: float = quantity(
        0.1, "1", "of a limb's length, where its samples begin", "choice: clear of the joint"
    )
    tip_samples: tuple[float, float] = quantity(
        (1.08, 1.15), "1", "of the hand's length, the very end of the fingers", "choice: just beyond the fingertip"
    )
    empty_deviation: float = quantity(0.010, "m", "of a sample beside the skin", "choice: two pixels")
    min_depth: float = quantity(
        0.05, "m", "of a sample before the camera", "choice: what is nearer is no part of a scene"
    )
    hidden_distance: float = quantity(
        0.015, "m", "of something before a sample, beyond which it hides it", "choice: above depth noise"
    )
    max_skin_distance: float = quantity(
        0.12, "m", "from a sample to the nearest skin, beyond which skin says nothing", "choice: two arm's widths"
    )
    max_pull: float = quantity(0.05, "m", "of that distance that counts", "choice: an arm's width")
    # the body
    body_deviation: float = quantity(
        0.02, "m", "of the arm inside the trunk, and of the wrist nearer than an elbow bends", "choice: flesh gives"
    )
    shoulder_share: float = quantity(
        0.5, "1", "of the upper arm that may be inside the trunk", "choice: the shoulder itself is at the trunk's edge"
    )
    hand_deviation: float = quantity(
        0.035, "m", "of the fingertip from the straight line of the forearm", "choice: a wrist bent by 12 degrees"
    )
    # steps
    max_step: float = quantity(0.06, "m", "of a joint in one iteration", "choice: the distances stay nearly linear")
    final_step: float = quantity(
        5e-4, "m", "of the joints, at which the fit has converged", "choice: below its deviation"
    )
    damping: float = quantity(1e-6, "m^-2", "of the Gauss-Newton matrix", "choice: keeps it invertible")


DEFAULT = ArmFitTuning()


@dataclass(frozen=True, kw_only=True)
class Limb:
    """What is known of one arm before a look at it.

    Attributes:
        lengths: (3,) of upper arm, forearm and hand [m].
        variation: relative standard deviation of the lengths.
        span: from shoulder to wrist, which says how far the elbow is bent; None where that is not known [m].
    """

    lengths: np.ndarray
    variation: float = PERSON.length_variation
    span: float | None = None


@dataclass(frozen=True, kw_only=True)
class ChainFit:
    """Result of a fit.

    Attributes:
        joints: (4, 3) shoulder, elbow, wrist, fingertip [m].
        covariance: (12, 12) [m^2].
        cost: mean squared residual, about 1 for a good fit.
        used: number of skin points that the chain explains.
    """

    joints: np.ndarray
    covariance: np.ndarray
    cost: float
    used: int


def point_along(joints: np.ndarray, arm_coordinate: float) -> np.ndarray:
    """Point (3,) on the axis of an arm (4, 3) [m].

    Args:
        joints: shoulder, elbow, wrist, fingertip [m].
        arm_coordinate: 0 shoulder, 1 elbow, 2 wrist, 3 fingertip.
    """
    segment = min(int(arm_coordinate), 2)
    return joints[segment] + (arm_coordinate - segment) * (joints[segment + 1] - joints[segment])


def turned_about_shoulder(joints: np.ndarray, arm_coordinate: float, point: np.ndarray) -> np.ndarray:
    """An arm (4, 3) turned about its shoulder as one piece.

    Args:
        joints: shoulder, elbow, wrist, fingertip [m].
        arm_coordinate: of the point of its axis that shall point at `point`: 0 shoulder, 3 fingertip.
        point: (3,) [m].
    """
    return turned(joints, joints[0], point_along(joints, arm_coordinate), point)


def turned(points: np.ndarray, about: np.ndarray, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Points (n, 3) turned about a point (3,) the shortest way from where `before` (3,) lies to where `after` does."""
    from scipy.spatial.transform import Rotation

    start, end = unit(before - about), unit(after - about)
    axis = cross(start, end)
    turn = Rotation.from_rotvec(unit(axis) * math.atan2(np.linalg.norm(axis), start @ end))
    return about + turn.apply(points - about)


def nearest_on_chain(points: np.ndarray, joints: np.ndarray, radii: np.ndarray) -> tuple[np.ndarray, ...]:
    """Segment (n,), share along it (n,), signed distance to its surface (n,) and outward unit vector (n, 3)."""
    start, along = joints[:-1], np.diff(joints, axis=0)
    share = np.einsum("nkd,kd->nk", points[:, None] - start, along) / np.maximum((along**2).sum(axis=1), 1e-9)
    share = np.clip(share, 0.0, 1.0)
    offset = points[:, None] - (start + share[..., None] * along)
    length = np.linalg.norm(offset, axis=2)
    segment = np.argmin(length - radii, axis=1)
    pick = np.arange(len(points))
    distance = length[pick, segment]
    outward = offset[pick, segment] / np.maximum(distance, 1e-6)[:, None]
    return segment, share[pick, segment], distance - radii[segment], outward


def fit_chain(
    view: SkinView,
    start: np.ndarray,
    *,
    anchor: np.ndarray,
    gate: float,
    iterations: int,
    home: np.ndarray | None = None,
    scale: float = 1.0,
    limb: Limb | None = None,
    tuning: ArmFitTuning = DEFAULT,
) -> ChainFit:
    """Fit the chain to one view.

    Args:
        view: the skin.
        start: (4, 3) joints to begin with [m].
        anchor: (4,) standard deviation of the pull of each joint towards `home` [m].
        gate: points farther than this from the surface belong to something else [m].
        iterations: Gauss-Newton steps, at most.
        home: (4, 3), `start` if not given [m].
        scale: body size relative to 174 cm.
        limb: what is known of this arm; an adult's lengths times `scale` and any bend if not given.
        tuning: numbers.
    """
    q = start.astype(float).copy()
    limb, radii = limb or Limb(lengths=np.array(PERSON.arm_lengths) * scale), np.array(PERSON.arm_radii) * scale
    axis = _axis_samples(tuning)
    matrix, cost, used = np.eye(12), np.inf, 0
    for _ in range(iterations):
        matrix, vector, total, weight = np.zeros((12, 12)), np.zeros(12), 0.0, 0.0
        if len(view.points):
            segment, share, signed, outward = nearest_on_chain(view.points, q, radii)
            signed, outward = _facing_camera(view, radii[segment], signed, outward, tuning)
            mine = np.abs(signed) < gate
            used = int(mine.sum())
            if used:
                robust = 1.0 / (1.0 + (signed[mine] / tuning.outlier_distance) ** 2)
                w = robust / tuning.point_deviation**2 * min(1.0, tuning.independent_points / used)
                rows = _rows(segment[mine], share[mine], -outward[mine])
                _add(matrix, vector, rows, signed[mine], w)
                total += float((w * signed[mine] ** 2).sum())
                weight += float(w.sum()) * tuning.point_deviation**2
        total += _add_empty(matrix, vector, view, q, axis, tuning)
        total += _add_body(matrix, vector, view.trunk, q, scale, axis, tuning)
        _add_priors(matrix, vector, q, start if home is None else home, limb, anchor, tuning)
        step = np.linalg.solve(matrix + tuning.damping * np.eye(12), -vector)
        longest = np.linalg.norm(step.reshape(4, 3), axis=1).max()
        q += (step * min(1.0, tuning.max_step / max(longest, 1e-9))).reshape(4, 3)
        cost = total / max(weight, 1.0)
        if longest < tuning.final_step:
            break
    return ChainFit(joints=q, covariance=np.linalg.inv(matrix), cost=cost, used=used)


def _axis_samples(tuning: ArmFitTuning) -> tuple[np.ndarray, np.ndarray]:
    """Segment (n,) and share along it (n,) of the samples of the arm's axis."""
    segment = np.repeat(np.arange(3), tuning.samples)
    share = np.tile(np.linspace(tuning.first_sample, 1.0, tuning.samples), 3)
    return np.append(segment, [2] * len(tuning.tip_samples)), np.append(share, tuning.tip_samples)


def _facing_camera(
    view: SkinView, radii: np.ndarray, signed: np.ndarray, outward: np.ndarray, tuning: ArmFitTuning
) -> tuple[np.ndarray, np.ndarray]:
    """Skin that is seen faces the camera: what lies behind an axis is as far inside as if it had to come through."""
    to_camera = view.pose_camera_in_map[:3, 3] - view.points
    facing = np.einsum("ij,ij->i", outward, to_camera) / np.linalg.norm(to_camera, axis=1)
    behind = facing < tuning.back_cosine
    return np.where(behind, -signed - 2 * radii, signed), np.where(behind[:, None], -outward, outward)


def _rows(segment: np.ndarray, share: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Jacobian rows (n, 12) of a residual that changes by `direction` per motion of the point on the axis."""
    rows = np.zeros((len(segment), 4, 3))
    pick = np.arange(len(segment))
    rows[pick, segment] = (1 - share)[:, None] * direction
    rows[pick, segment + 1] += share[:, None] * direction
    return rows.reshape(-1, 12)


def _add(matrix: np.ndarray, vector: np.ndarray, rows: np.ndarray, residual: np.ndarray, weight: np.ndarray) -> None:
    weighted = rows * weight[:, None]
    matrix += rows.T @ weighted
    vector += weighted.T @ residual


def _add_empty(
    matrix: np.ndarray,
    vector: np.ndarray,
    view: SkinView,
    q: np.ndarray,
    axis: tuple[np.ndarray, np.ndarray],
    tuning: ArmFitTuning,
) -> float:
    """Add samples of the axis that are seen to be empty: no skin there and nothing in front."""
    segment, share = axis
    samples = q[segment] + share[:, None] * (q[segment + 1] - q[segment])
    fx, rotation = view.intrinsics[0], view.pose_camera_in_map[:3, :3]
    u, v, z = project(view, samples).T
    u, v = np.round(u).astype(int), np.round(v).astype(int)
    height, width = view.depth.shape
    inside = (z > tuning.min_depth) & (u >= 0) & (u < width) & (v >= 0) & (v < height)
    if not inside.any():
        return 0.0
    u, v, z, segment, share = u[inside], v[inside], z[inside], segment[inside], share[inside]
    seen = view.depth[v, u]
    metres = view.to_skin[v, u] * z / fx
    # hidden behind something nearer, without depth, or so far from all skin that skin says nothing
    count = (seen > z - tuning.hidden_distance) & (metres > 1e-6) & (metres < tuning.max_skin_distance)
    if not count.any():
        return 0.0
    metres = np.minimum(metres, tuning.max_pull)
    slope = view.gradient[:, v, u]
    direction = slope[0][:, None] * rotation[:, 0] + slope[1][:, None] * rotation[:, 1]
    w = np.full(int(count.sum()), 1 / tuning.empty_deviation**2)
    _add(matrix, vector, _rows(segment[count], share[count], direction[count]), metres[count], w)
    return float((w * metres[count] ** 2).sum())


def _add_body(
    matrix: np.ndarray,
    vector: np.ndarray,
    trunk: Trunk | None,
    q: np.ndarray,
    scale: float,
    axis: tuple[np.ndarray, np.ndarray],
    tuning: ArmFitTuning,
) -> float:
    """Add what a body allows: no arm inside the trunk, no elbow folded shut."""
    total = 0.0
    if trunk is not None:
        far = (axis[0] > 0) | (axis[1] > tuning.shoulder_share)
        segment, share = axis[0][far], axis[1][far]
        depth = trunk.depth_inside(q[segment] + share[:, None] * (q[segment + 1] - q[segment]))
        deep = depth > 0
        if deep.any():
            outward = np.tile((-trunk.sign, 0.0, 0.0), (int(deep.sum()), 1))
            w = np.full(len(outward), 1 / tuning.body_deviation**2)
            _add(matrix, vector, _rows(segment[deep], share[deep], outward), depth[deep], w)
            total += float((w * depth[deep] ** 2).sum())
    row, reach = span_row(q)
    lacking = PERSON.shortest_span * scale - reach
    if lacking > 0:
        _add(matrix, vector, -row, np.array([lacking]), np.array([1 / tuning.body_deviation**2]))
        total += (lacking / tuning.body_deviation) ** 2
    return total


def _add_priors(
    matrix: np.ndarray,
    vector: np.ndarray,
    q: np.ndarray,
    home: np.ndarray,
    limb: Limb,
    anchor: np.ndarray,
    tuning: ArmFitTuning,
) -> None:
    """Add lengths, the elbow's bend, straightness of the hand and the pull towards home."""
    rows, size = length_rows(q)
    lengths = limb.lengths
    _add(matrix, vector, rows, size - lengths, 1 / (limb.variation * lengths) ** 2)
    if limb.span is not None:
        row, reach = span_row(q)
        _add(matrix, vector, row, np.array([reach - limb.span]), np.array([1 / PERSON.span_deviation**2]))
    # fingertip = wrist + hand length along the forearm
    k = lengths[2] / lengths[1]
    bend = np.zeros((3, 4, 3))
    for d in range(3):
        bend[d, 3, d], bend[d, 2, d], bend[d, 1, d] = 1.0, -(1 + k), k
    straight = np.full(3, 1 / tuning.hand_deviation**2)
    _add(matrix, vector, bend.reshape(3, 12), q[3] - (1 + k) * q[2] + k * q[1], straight)
    pull = np.repeat(1 / anchor**2, 3)
    matrix += np.diag(pull)
    vector += pull * (q - home).ravel()


def length_rows(q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Jacobian rows (3, 12) of the lengths of upper arm, forearm and hand, and these lengths (3,) [m]."""
    along = np.diff(q, axis=0)
    size = np.linalg.norm(along, axis=1)
    rows = np.zeros((3, 4, 3))
    for k in range(3):
        rows[k, k + 1] = along[k] / size[k]
        rows[k, k] = -rows[k, k + 1]
    return rows.reshape(3, 12), size


def span_row(q: np.ndarray) -> tuple[np.ndarray, float]:
    """Jacobian row (1, 12) of the distance from shoulder to wrist, and that distance [m]."""
    reach = q[2] - q[0]
    size = float(np.linalg.norm(reach))
    row = np.zeros((1, 4, 3))
    row[0, 2] = reach / max(size, 1e-6)
    row[0, 0] = -row[0, 2]
    return row.reshape(1, 12), size
