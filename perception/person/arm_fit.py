"""The arm as three capsules, fitted to depth points by damped least squares.

Unknowns are the four joint centres q = (shoulder, elbow, wrist, fingertip), 12 numbers.  Residuals, each divided by its
standard deviation: signed distance of every skin point to the nearest capsule's surface; every sample of the
axis that the image shows to be empty, by its distance to the nearest skin; lengths of an adult; a straight
hand; and a weak pull towards a home, which keeps what nothing observes where it was.  The inverse of the
Gauss-Newton matrix at the end is the covariance, so an unobserved joint says so itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..image.cloud import unit
from ..image.projection import project

LENGTHS = np.array((0.28, 0.25, 0.175))  # upper arm, forearm, hand of an adult of 174 cm [m]
RADII = np.array((0.041, 0.036, 0.030))  # of the same [m]
_POINT_SIGMA = 0.012  # one point to the surface: sensor noise and limbs that are no capsules [m]
_EFFECTIVE = 30  # that many of the points are independent: neighbours share their error
_EMPTY_SIGMA = 0.010  # an axis sample beside the skin: two pixels [m]
_BEHIND = -0.5  # cosine towards the camera at which a point is on the far side of the axis
_BODY_SIGMA = 0.02  # how firmly the trunk and the elbow's limit hold [m]
# Friction holds an elbow that its owner cannot move: what lies between shoulder and wrist stays, in an arm that was
# straight to an angle of 30 degrees [m].
SPAN_SIGMA = 0.015
_NEAREST_WRIST = 0.30  # from the shoulder: an elbow at 111 degrees, more than an arm at rest bends [m]
_SEGMENT = np.repeat(np.arange(3), 6)  # samples along each capsule's axis, and the very end of the fingers
_SHARE = np.tile(np.linspace(0.1, 1.0, 6), 3)
_SEGMENT, _SHARE = np.append(_SEGMENT, (2, 2)), np.append(_SHARE, (1.08, 1.15))


@dataclass(frozen=True, kw_only=True)
class Trunk:
    """The half of the trunk that no part of the arm can be in, a box open downwards.

    Attributes:
        middle: x of the body's midline [m].
        sign: 1 for the arm on the side of larger x, -1 for the other.
        half_width: of the trunk [m].
        top: z up to which it reaches [m].
        low, high: where it begins and ends along y [m].
    """

    middle: float
    sign: float
    half_width: float
    top: float
    low: float
    high: float

    def depth_inside(self, points: np.ndarray) -> np.ndarray:
        """How far (n,) points (n, 3) lie inside its flank, 0 outside [m]."""
        inside = (points[:, 2] < self.top) & (points[:, 1] > self.low) & (points[:, 1] < self.high)
        return np.where(inside, np.maximum(self.half_width - self.sign * (points[:, 0] - self.middle), 0.0), 0.0)


@dataclass(frozen=True, kw_only=True)
class SkinView:
    """What one frame says about skin.

    Attributes:
        points: (n, 3) skin in the map, thinned [m].
        depth: (H, W) [m].
        to_skin: (H, W) distance of every pixel to the nearest skin pixel [px].
        gradient: (2, H, W) of `to_skin` along u and v.
        intrinsics: (fx, fy, cx, cy) [px].
        pose_camera_in_map: (4, 4).
        trunk: where the arm cannot be, if it is known.
    """

    points: np.ndarray
    depth: np.ndarray
    to_skin: np.ndarray
    gradient: np.ndarray
    intrinsics: tuple[float, float, float, float]
    pose_camera_in_map: np.ndarray
    trunk: Trunk | None = None


@dataclass(frozen=True, kw_only=True)
class Limb:
    """What is known of one arm before a look at it.

    Attributes:
        lengths: (3,) of upper arm, forearm and hand [m].
        sigma: relative standard deviation of the lengths.
        span: from shoulder to wrist, which says how far the elbow is bent; None where that is not known [m].
    """

    lengths: np.ndarray
    sigma: float = 0.06
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


def point_along(joints: np.ndarray, fraction: float) -> np.ndarray:
    """Point (3,) on the axis of an arm (4, 3), `fraction` 0 at the shoulder to 3 at the fingertip [m]."""
    segment = min(int(fraction), 2)
    return joints[segment] + (fraction - segment) * (joints[segment + 1] - joints[segment])


def turned_about_shoulder(joints: np.ndarray, fraction: float, point: np.ndarray) -> np.ndarray:
    """An arm (4, 3) turned about its shoulder until `fraction` of it (0 shoulder, 3 fingertip) points at (3,) [m]."""
    from scipy.spatial.transform import Rotation

    before, after = unit(point_along(joints, fraction) - joints[0]), unit(point - joints[0])
    axis = np.cross(before, after)
    if not axis.any():
        return joints.copy()
    turn = Rotation.from_rotvec(unit(axis) * np.arctan2(np.linalg.norm(axis), before @ after))
    return joints[0] + turn.apply(joints - joints[0])


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
    home: np.ndarray | None = None,
    scale: float = 1.0,
    limb: Limb | None = None,
    gate: float = 0.08,
    iterations: int = 8,
) -> ChainFit:
    """Fit the chain to one view.

    Args:
        view: the skin.
        start: (4, 3) joints to begin with [m].
        anchor: (4,) standard deviation of the pull of each joint towards `home` [m].
        home: (4, 3), `start` if not given [m].
        scale: body size relative to 174 cm.
        limb: what is known of this arm; an adult's lengths times `scale` and any bend if not given.
        gate: points farther than this from the surface belong to something else [m].
        iterations: Gauss-Newton steps.
    """
    q = start.astype(float).copy()
    limb, radii = limb or Limb(lengths=LENGTHS * scale), RADII * scale
    matrix, cost, used = np.eye(12), np.inf, 0
    for _ in range(iterations):
        matrix, vector, total, weight = np.zeros((12, 12)), np.zeros(12), 0.0, 0.0
        if len(view.points):
            segment, share, signed, outward = nearest_on_chain(view.points, q, radii)
            signed, outward = _facing_camera(view, radii[segment], signed, outward)
            mine = np.abs(signed) < gate
            used = int(mine.sum())
            if used:
                robust = 1.0 / (1.0 + (signed[mine] / 0.03) ** 2)
                w = robust / _POINT_SIGMA**2 * min(1.0, _EFFECTIVE / used)
                rows = _rows(segment[mine], share[mine], -outward[mine])
                _add(matrix, vector, rows, signed[mine], w)
                total += float((w * signed[mine] ** 2).sum())
                weight += float(w.sum()) * _POINT_SIGMA**2
        total += _add_empty(matrix, vector, view, q) + _add_body(matrix, vector, view.trunk, q, scale)
        _add_priors(matrix, vector, q, start if home is None else home, limb, anchor)
        step = np.linalg.solve(matrix + 1e-6 * np.eye(12), -vector)
        longest = np.linalg.norm(step.reshape(4, 3), axis=1).max()
        q += (step * min(1.0, 0.06 / max(longest, 1e-9))).reshape(4, 3)
        cost = total / max(weight, 1.0)
        if longest < 5e-4:
            break
    return ChainFit(joints=q, covariance=np.linalg.inv(matrix), cost=cost, used=used)


def _facing_camera(
    view: SkinView, radii: np.ndarray, signed: np.ndarray, outward: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Skin that is seen faces the camera: what lies behind an axis is as far inside as if it had to come through."""
    to_camera = view.pose_camera_in_map[:3, 3] - view.points
    facing = np.einsum("ij,ij->i", outward, to_camera) / np.linalg.norm(to_camera, axis=1)
    behind = facing < _BEHIND
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


def _add_empty(matrix: np.ndarray, vector: np.ndarray, view: SkinView, q: np.ndarray) -> float:
    """Add samples of the axis that are seen to be empty: no skin there and nothing in front."""
    segment, share = _SEGMENT, _SHARE
    samples = q[segment] + share[:, None] * (q[segment + 1] - q[segment])
    fx, rotation = view.intrinsics[0], view.pose_camera_in_map[:3, :3]
    u, v, z = project(view, samples).T
    u, v = np.round(u).astype(int), np.round(v).astype(int)
    height, width = view.depth.shape
    inside = (z > 0.05) & (u >= 0) & (u < width) & (v >= 0) & (v < height)
    if not inside.any():
        return 0.0
    u, v, z, segment, share = u[inside], v[inside], z[inside], segment[inside], share[inside]
    seen = view.depth[v, u]
    metres = view.to_skin[v, u] * z / fx
    # hidden behind something nearer, without depth, or so far from all skin that skin says nothing
    count = (seen > z - 0.015) & (metres > 1e-6) & (metres < 0.12)
    if not count.any():
        return 0.0
    metres = np.minimum(metres, 0.05)
    slope = view.gradient[:, v, u]
    direction = slope[0][:, None] * rotation[:, 0] + slope[1][:, None] * rotation[:, 1]
    w = np.full(int(count.sum()), 1 / _EMPTY_SIGMA**2)
    _add(matrix, vector, _rows(segment[count], share[count], direction[count]), metres[count], w)
    return float((w * metres[count] ** 2).sum())


def _add_body(matrix: np.ndarray, vector: np.ndarray, trunk: Trunk | None, q: np.ndarray, scale: float) -> float:
    """Add what a body allows: no arm inside the trunk, no elbow folded shut."""
    total = 0.0
    if trunk is not None:
        far = (_SEGMENT > 0) | (_SHARE > 0.5)  # the shoulder itself is at the trunk's edge
        segment, share = _SEGMENT[far], _SHARE[far]
        depth = trunk.depth_inside(q[segment] + share[:, None] * (q[segment + 1] - q[segment]))
        deep = depth > 0
        if deep.any():
            outward = np.tile((-trunk.sign, 0.0, 0.0), (int(deep.sum()), 1))
            w = np.full(len(outward), 1 / _BODY_SIGMA**2)
            _add(matrix, vector, _rows(segment[deep], share[deep], outward), depth[deep], w)
            total += float((w * depth[deep] ** 2).sum())
    row, reach = span_row(q)
    lacking = _NEAREST_WRIST * scale - reach
    if lacking > 0:
        _add(matrix, vector, -row, np.array([lacking]), np.array([1 / _BODY_SIGMA**2]))
        total += (lacking / _BODY_SIGMA) ** 2
    return total


def _add_priors(
    matrix: np.ndarray, vector: np.ndarray, q: np.ndarray, home: np.ndarray, limb: Limb, anchor: np.ndarray
) -> None:
    """Add lengths, the elbow's bend, straightness of the hand and the pull towards home."""
    along = np.diff(q, axis=0)
    size = np.linalg.norm(along, axis=1)
    rows = np.zeros((3, 4, 3))
    for k in range(3):
        rows[k, k + 1] = along[k] / size[k]
        rows[k, k] = -rows[k, k + 1]
    lengths = limb.lengths
    _add(matrix, vector, rows.reshape(3, 12), size - lengths, 1 / (limb.sigma * lengths) ** 2)
    if limb.span is not None:
        row, reach = span_row(q)
        _add(matrix, vector, row, np.array([reach - limb.span]), np.array([1 / SPAN_SIGMA**2]))
    # fingertip = wrist + hand length along the forearm, within about 12 degrees
    k = lengths[2] / lengths[1]
    bend = np.zeros((3, 4, 3))
    for d in range(3):
        bend[d, 3, d], bend[d, 2, d], bend[d, 1, d] = 1.0, -(1 + k), k
    _add(matrix, vector, bend.reshape(3, 12), q[3] - (1 + k) * q[2] + k * q[1], np.full(3, 1 / 0.035**2))
    pull = np.repeat(1 / anchor**2, 3)
    matrix += np.diag(pull)
    vector += pull * (q - home).ravel()


def span_row(q: np.ndarray) -> tuple[np.ndarray, float]:
    """Jacobian row (1, 12) of the distance from shoulder to wrist, and that distance [m]."""
    reach = q[2] - q[0]
    size = float(np.linalg.norm(reach))
    row = np.zeros((1, 4, 3))
    row[0, 2] = reach / max(size, 1e-6)
    row[0, 0] = -row[0, 2]
    return row.reshape(1, 12), size
