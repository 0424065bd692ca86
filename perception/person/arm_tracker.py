"""One arm of the person over time, through occlusion by the gown and the robot.

Each frame is fitted on its own (`chain`); a constant-velocity Kalman filter on the four joint centres takes
the fit with the fit's own covariance.  What the cloth hides has a large covariance in the fit and is carried
by the lengths of the limb, by its last motion, which dies out, and by the gripper that holds the arm.
"""

from __future__ import annotations

import copy
import itertools
from typing import Any

import numpy as np

from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import ArmPosture
from ..image.projection import pixels_of
from ..image.surfaces import Surface, surfaces
from .arm_fit import (
    LENGTHS,
    SPAN_SIGMA,
    ChainFit,
    Limb,
    SkinView,
    Trunk,
    fit_chain,
    point_along,
    span_row,
    turned_about_shoulder,
)
from .skin import (
    CROWN_TO_SHOULDER,
    HEAD_HEIGHT,
    SHOULDER_ABOVE_BED,
    SHOULDER_HALF_WIDTH,
    TRUNK_HALF_WIDTH,
    head_seen,
    skin_on_bed,
)

_MARGIN = 0.03  # between the trunk and skin that is taken for the arm [m]
_POINTS = 350  # skin points per fit
_GATE = 40.0  # squared Mahalanobis distance of a whole fit, 12 degrees of freedom (99.99 %)
_FADE = 0.4  # time after which a motion has died out [s]
_RECENT = 0.5  # what was seen or held that lately may be moving [s]
# Speed of the joints, standard deviation [m/s]: in view anything goes; held by the robot it may be moving where it
# is not seen; let go of it may sink for a while; an arm that its owner cannot move, unseen and not held, stays where it
# is but for small slips.
_SPEED_SEEN, _SPEED_HELD, _SPEED_SINKING, _SPEED_HIDDEN = 0.10, 0.03, 0.06, 0.003
_SINKING = 15.0  # after it was let go [s]
_SHOULDER_PLAY = 0.02  # how far the shoulder joint moves with the arm, standard deviation [m]
_EXPLAINED = 0.85  # share of the skin beside the trunk that the arm has to explain
_WORST = 6.0  # mean squared residual of a fit that is believed
_SIZES = (0.85, 1.15)  # of bodies, relative to 174 cm
_PITCHES = np.deg2rad((-6.0, 30.0))  # at which an arm is looked for: at rest on the bed, and as a robot leaves it
_ABDUCTIONS, _BENDS = np.deg2rad((15.0, 40.0, 65.0)), np.deg2rad((0.0, 45.0))
# How far joints may be from where a search starts: from one posture of many, and from where they were last [m].
_ANYWHERE, _NEARBY = np.array((0.03, 0.20, 0.30, 0.40)), np.array((0.03, 0.08, 0.10, 0.12))
_BETTER = 0.3  # by which another start must explain a picture better than those tried before it
_OFF = 0.10  # from where the head says that it is, a shoulder is not believed [m]
_FAR = 0.05  # a held point that far from where it is expected turns the whole arm at once [m]
_TWIST = 0.2  # share of the way of a turned arm's joints that is not known: it may twist about its axis
_WELL = 0.04  # deviation of every joint at which the first look has seen a whole arm [m]
_KNOWN_SIGMA = 0.03  # relative, of lengths that were seen once
_LOST = 0.10  # standard deviation at which a joint counts as lost [m]
# An arm that shows at no more of its places than that is not where it was; one looked for afresh shows at half of them.
_PLACES, _GONE, _SHOWS = np.linspace(0.8, 3.0, 23), 0.2, 0.5
_THICK = 0.09  # skin that is that much nearer or farther than an arm's axis is not that arm's [m]


class ArmTracker:
    """Shoulder, elbow, wrist and fingertip of one arm.

    Usage: `update` with every head frame, `update_grip` whenever the robot's hand holds the arm, `estimate`
    whenever the posture is needed.  Times are the world's clock and must not run backwards.
    """

    def __init__(self, side: Side, bed: np.ndarray, scale: float | None = None) -> None:
        """Start without an estimate.

        Args:
            side: the person's own left or right.
            bed: (2, 3) lower and upper corner of the bed in the map [m].
            scale: body size relative to an adult of 174 cm; judged by the size of the head when omitted.
        """
        self.side: Side = side
        self.bed = np.asarray(bed, dtype=float)
        self.scale = scale or 1.0
        self._judge_size = scale is None
        self.time = 0.0
        self.seen = -np.inf  # when skin of this arm was last explained
        self.held = -np.inf  # when the robot last said that it holds it
        self.middle = float(self.bed[:, 0].mean())
        self.shoulder_y = -np.inf
        self._sign = 1.0 if side == "right" else -1.0  # the person's right is +x
        self._limb: Limb | None = None  # of an arm that was seen whole once
        self._filter: Any = None
        self._rejected = 0
        self._wrong = 0
        self._frame_stamp = -np.inf

    @property
    def started(self) -> bool:
        """True once the arm has been found."""
        return self._filter is not None

    def update(self, frame: Frame) -> int:
        """Take one frame into account.

        Returns:
            How many skin points the arm explains; 0 when it is hidden.

        Raises:
            PerceptionFailure: the arm has never been found and is not in this frame either.
        """
        view = self._view(frame)
        if self._filter is None:
            self._start(frame, view)
            return len(view.points)
        if frame.stamp <= self._frame_stamp:
            return 0  # a picture seen twice is not new evidence
        self._frame_stamp = frame.stamp
        self._predict(frame.stamp)
        if self._deviation().max() > _LOST:
            return self._find_again(frame, view)
        if len(view.points) < 15:
            return 0
        home = self._joints()
        home[0] = self._shoulder  # the trunk stays on the bed, and clothes hide the shoulder most of the time
        anchor = np.clip(3 * self._deviation(), 0.05, _NEARBY.max())
        anchor[0] = _SHOULDER_PLAY
        fit = fit_chain(
            view,
            self._joints(),
            anchor=anchor,
            home=home,
            scale=self.scale,
            limb=self._limb,
            iterations=5,
            gate=float(np.clip(3 * self._deviation().max(), 0.05, 0.12)),
        )
        self._wrong = self._wrong + 1 if fit.used < _EXPLAINED * len(view.points) or fit.cost > _WORST else 0
        if self._wrong >= 5:
            return self._find_again(frame, view)
        if fit.used < 15:
            return 0
        if self._surprise(fit) > _GATE:
            self._rejected += 1
            if self._rejected < 3:
                return 0
            self._filter.P[:12, :12] += np.eye(12) * 0.05**2  # three in a row: the arm did move
        self._rejected = 0
        self._measure(fit.joints.ravel(), np.eye(12), fit.covariance + np.eye(12) * 0.004**2)
        self._keep_lengths()
        self.seen = frame.stamp
        return fit.used

    def look_afresh(self, frame: Frame) -> bool:
        """Look for the arm all over a picture in which it does not show where it was.

        Returns:
            Whether it was found elsewhere, with bare skin all along it; if not, nothing changes.
        """
        if self._limb is None or self._bare(frame) > _GONE:
            return False
        other = copy.copy(self)
        try:
            other._start(frame, other._view(frame))
        except PerceptionFailure:
            return False
        if other._bare(frame) < _SHOWS:
            return False
        self.__dict__.update(other.__dict__)
        return True

    def update_grip(self, time: float, point_in_map: np.ndarray, fraction: float, deviation: float = 0.02) -> None:
        """The robot's fingers hold the arm: its axis passes through a known point.

        Args:
            time: world clock [s].
            point_in_map: (3,) of the arm's axis between the fingers [m].
            fraction: where along the arm, 0 shoulder, 1 elbow, 2 wrist, 3 fingertip.
            deviation: standard deviation of the point [m].

        Raises:
            PerceptionFailure: the arm has never been found.
        """
        if self._filter is None:
            raise PerceptionFailure(Problem.NOTHING_SEEN, f"{self.side} arm")
        self._predict(time)
        self._turn_to(np.asarray(point_in_map, dtype=float), fraction)
        self.held = time
        segment = min(int(fraction), 2)
        share = float(np.clip(fraction - segment, 0.0, 1.0))
        rows = np.zeros((3, 12))
        rows[:, 3 * segment : 3 * segment + 3] = (1 - share) * np.eye(3)
        rows[:, 3 * segment + 3 : 3 * segment + 6] = share * np.eye(3)
        self._measure(np.asarray(point_in_map, dtype=float), rows, np.eye(3) * deviation**2)
        self._keep_lengths()

    def estimate(self, time: float) -> ArmPosture:
        """Posture at `time` [s], not before the last update.

        Raises:
            PerceptionFailure: never found (`NOTHING_SEEN`) or too uncertain (`ARM_LOST`).
        """
        if self._filter is None:
            raise PerceptionFailure(Problem.NOTHING_SEEN, f"{self.side} arm")
        self._predict(time)
        deviation = self._deviation()
        if deviation.max() > _LOST:
            raise PerceptionFailure(Problem.ARM_LOST, f"{self.side} arm")
        return ArmPosture(
            stamp=self.time,
            confidence=float(np.exp(-deviation.max() / 0.05)),
            side=self.side,
            points_in_map=self._joints(),
            deviation=deviation,
        )

    def _turn_to(self, point: np.ndarray, fraction: float) -> None:
        """Turn the arm about its shoulder as one piece until `fraction` of it points at where the robot holds it.

        A filter that is told of an elbow far from where it was leaves the hand behind.
        """
        joints = self._joints()
        if np.linalg.norm(point - point_along(joints, fraction)) < _FAR:
            return
        turned = turned_about_shoulder(joints, fraction, point)
        moved = np.linalg.norm(turned - joints, axis=1)
        self._filter.x[:12] = turned.ravel()
        self._filter.P[:12, :12] += np.diag(np.repeat((_TWIST * moved) ** 2, 3))

    def _bare(self, frame: Frame) -> float:
        """Share of the arm's places below the upper arm's middle at which a picture shows skin."""
        places = np.array([point_along(self._joints(), float(p)) for p in _PLACES])
        rows, columns, depth, inside = pixels_of(frame, places)
        skin = surfaces(frame.rgb)[rows, columns] == Surface.SKIN
        return float((inside & skin & (np.abs(frame.depth[rows, columns] - depth) < _THICK)).mean())

    def _joints(self) -> np.ndarray:
        return self._filter.x[:12].reshape(4, 3).copy()

    def _deviation(self) -> np.ndarray:
        """Standard deviation (4,) of each joint in its worst direction of the axes [m]."""
        return np.sqrt(np.maximum(np.diag(self._filter.P)[:12], 1e-8).reshape(4, 3).max(axis=1))

    def _find_again(self, frame: Frame, view: SkinView) -> int:
        """Start over where the arm is too uncertain to be followed; keep what there is if it is not seen."""
        try:
            self._start(frame, view)
        except PerceptionFailure:
            return 0
        return len(view.points)

    def _view(self, frame: Frame) -> SkinView:
        import cv2

        points, skin = skin_on_bed(frame, self.bed, inner=True)
        side = (points[:, 0] - self.middle) * self._sign
        below_head = points[:, 1] > (self.shoulder_y - 0.10)
        mine = points[(side > TRUNK_HALF_WIDTH * self.scale + _MARGIN) & below_head]
        if len(mine) > _POINTS:
            mine = mine[np.linspace(0, len(mine) - 1, _POINTS).astype(int)]
        if skin.any():
            to_skin = cv2.distanceTransform((~skin).astype(np.uint8), cv2.DIST_L2, 3)
            gradient = np.stack(
                [
                    cv2.Sobel(to_skin, cv2.CV_32F, 1, 0, ksize=3, scale=0.125),
                    cv2.Sobel(to_skin, cv2.CV_32F, 0, 1, ksize=3, scale=0.125),
                ]
            )
        else:
            to_skin, gradient = np.full(skin.shape, 1e3, np.float32), np.zeros((2, *skin.shape), np.float32)
        trunk = Trunk(
            middle=self.middle,
            sign=self._sign,
            half_width=0.95 * TRUNK_HALF_WIDTH * self.scale,
            top=self.bed[1, 2] + 0.20,
            low=self.shoulder_y - 0.05,
            high=self.shoulder_y + 0.60,
        )
        return SkinView(
            points=mine,
            trunk=trunk,
            depth=frame.depth,
            to_skin=to_skin,
            gradient=gradient,
            intrinsics=frame.intrinsics,
            pose_camera_in_map=frame.pose_camera_in_map,
        )

    def _start(self, frame: Frame, view: SkinView) -> None:
        """Find the arm: try a fan of postures next to the trunk, keep the one that explains the skin best."""
        if not self.started:  # the trunk stays where it lies, and is best seen before anything covers it
            self._find_trunk(frame)
        view = self._view(frame)
        if len(view.points) < 40:
            raise PerceptionFailure(Problem.NOTHING_SEEN, f"{self.side} arm")
        shoulder = np.array(
            (
                self.middle + self._sign * SHOULDER_HALF_WIDTH * self.scale,
                self.shoulder_y,
                self.bed[1, 2] + SHOULDER_ABOVE_BED,
            )
        )
        bends = _BENDS if self._limb is None else _BENDS[:1]
        starts = [
            (self._posture(shoulder, *angles), _ANYWHERE) for angles in itertools.product(_PITCHES, _ABDUCTIONS, bends)
        ]
        if self.started:
            starts.insert(0, (self._joints(), _NEARBY))
        best: tuple[float, ChainFit, np.ndarray] | None = None
        for start, anchor in starts:
            fit = fit_chain(view, start, scale=self.scale, limb=self._limb, gate=0.15, anchor=anchor, iterations=15)
            missed = 1 - fit.used / len(view.points)
            score = fit.cost + 20 * missed
            if best is None or score < best[0] - _BETTER:
                best = score, fit, anchor
        assert best is not None
        home = best[1].joints.copy()
        home[0] = shoulder  # which lies on the bed however the arm is raised
        fit = fit_chain(
            view, best[1].joints, scale=self.scale, limb=self._limb, gate=0.06, home=home, anchor=best[2], iterations=10
        )
        if fit.used < 0.7 * len(view.points) or np.linalg.norm(fit.joints[0] - shoulder) > _OFF:
            raise PerceptionFailure(Problem.NOTHING_SEEN, f"{self.side} arm")
        self._make_filter(fit, frame.stamp)

    def _find_trunk(self, frame: Frame) -> None:
        """Middle, size and shoulders of the body by its head."""
        head = head_seen(frame, self.bed)
        self.middle = head.middle
        if self._judge_size:
            self.scale = float(np.clip((head.crown_in_map[2] - self.bed[1, 2]) / HEAD_HEIGHT, *_SIZES))
        self.shoulder_y = float(head.crown_in_map[1]) + CROWN_TO_SHOULDER * self.scale

    def _posture(self, shoulder: np.ndarray, pitch: float, abduction: float, bend: float) -> np.ndarray:
        """Joints (4, 3) of an arm raised by `pitch`, its forearm turned towards the body by `bend` [rad]."""
        flat, up = np.cos(pitch), np.sin(pitch)
        upper = np.array((self._sign * flat * np.sin(abduction), flat * np.cos(abduction), up))
        fore = np.array((self._sign * flat * np.sin(abduction - bend), flat * np.cos(abduction - bend), up))
        lengths = LENGTHS * self.scale
        elbow = shoulder + lengths[0] * upper
        wrist = elbow + lengths[1] * fore
        return np.array((shoulder, elbow, wrist, wrist + lengths[2] * fore))

    def _make_filter(self, fit: ChainFit, stamp: float) -> None:
        from filterpy.kalman import KalmanFilter

        self._filter = KalmanFilter(dim_x=24, dim_z=12)
        self._filter.x = np.concatenate([fit.joints.ravel(), np.zeros(12)])
        self._filter.P = np.zeros((24, 24))
        self._filter.P[:12, :12] = fit.covariance + np.eye(12) * 0.004**2
        self._filter.P[12:, 12:] = np.eye(12) * 0.02**2
        # lengths as they are seen, between the fit and the prior, stay fixed from now on
        if self._limb is None:
            self._lengths = np.linalg.norm(np.diff(fit.joints, axis=0), axis=1)
            self._shoulder = fit.joints[0].copy()
            if self._deviation().max() < _WELL:
                self._limb = Limb(lengths=self._lengths, sigma=_KNOWN_SIGMA, span=span_row(fit.joints)[1])
        self._rejected = self._wrong = 0
        self.time = self.seen = self._frame_stamp = stamp

    def _predict(self, time: float) -> None:
        step = time - self.time
        if step <= 0:
            return
        self.time = time
        fade = float(np.exp(-step / _FADE))
        travel = _FADE * (1 - fade)
        transition = np.eye(24)
        transition[:12, 12:] = travel * np.eye(12)
        transition[12:, 12:] = fade * np.eye(12)
        noise = np.zeros((24, 24))
        recently_seen, recently_held = time - self.seen < _RECENT, time - self.held < _RECENT
        may_sink = time - self.held < _SINKING
        speed = (
            _SPEED_SEEN
            if recently_seen
            else _SPEED_HELD
            if recently_held
            else _SPEED_SINKING
            if may_sink
            else _SPEED_HIDDEN
        )
        noise[12:, 12:] = np.eye(12) * speed**2 * (1 - fade**2)
        noise[:12, :12] = np.eye(12) * 2 * speed**2 * _FADE * step * (1 - (1 - fade) * _FADE / step)
        self._filter.F, self._filter.Q = transition, noise
        self._filter.predict()

    def _surprise(self, fit: ChainFit) -> float:
        """Squared Mahalanobis distance between a fit and the prediction."""
        gap = fit.joints.ravel() - self._filter.x[:12]
        return float(gap @ np.linalg.solve(self._filter.P[:12, :12] + fit.covariance + np.eye(12) * 0.006**2, gap))

    def _measure(self, value: np.ndarray, rows: np.ndarray, covariance: np.ndarray) -> None:
        full = np.zeros((len(value), 24))
        full[:, :12] = rows
        self._filter.update(value, R=covariance, H=full)
        self._filter.P = (self._filter.P + self._filter.P.T) / 2

    def _keep_lengths(self) -> None:
        """Limbs do not stretch: their lengths are a measurement too."""
        joints = self._joints()
        along = np.diff(joints, axis=0)
        size = np.linalg.norm(along, axis=1)
        rows = np.zeros((3, 4, 3))
        for k in range(3):
            rows[k, k + 1] = along[k] / size[k]
            rows[k, k] = -rows[k, k + 1]
        rows = rows.reshape(3, 12)
        self._measure(self._lengths - size + rows @ self._filter.x[:12], rows, np.eye(3) * 0.006**2)
        if self._limb is not None and self._limb.span is not None:
            row, reach = span_row(self._joints())
            self._measure(self._limb.span - reach + row @ self._filter.x[:12], row, np.eye(1) * SPAN_SIGMA**2)
