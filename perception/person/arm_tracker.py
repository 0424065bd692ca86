"""One arm of the person over time, through occlusion by the gown and the robot.

Each frame is fitted on its own (`arm_fit`); a constant-velocity Kalman filter on the four joint centres (`arm_filter`)
takes the fit with the fit's own covariance.  What the cloth hides has a large covariance in the fit and is carried by
the lengths of the limb, by its last motion, which dies out, and by the gripper that holds the arm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Frame, Side
from ..errors import PerceptionFailure, Problem
from ..estimates import ArmPosture
from ..image.projection import pixels_of
from ..image.surfaces import Surface, surfaces_at
from .arm_filter import ArmFilter, ArmFilterTuning
from .arm_fit import ArmFitTuning, ChainFit, Limb, fit_chain, point_along, span_row
from .arm_search import ArmSearchTuning, find_arm
from .head import DEFAULT as HEAD_DEFAULT
from .head import HeadTuning
from .lying_body import LyingBody, body_seen
from .skin import DEFAULT as SKIN_DEFAULT
from .skin import SkinTuning
from .skin_view import SkinView, SkinViewTuning, skin_view


@dataclass(frozen=True, kw_only=True)
class ArmTrackerTuning(Quantities):
    """Numbers of the tracker, and of what it is made of."""

    # How fast the joints may move, standard deviation: in view anything goes; held by the robot they may be moving
    # where they are not seen; let go of the arm may sink for a while; an arm that its owner cannot move, unseen and not
    # held, stays where it is but for small slips.
    seen_speed: float = quantity(0.10, "m/s", "of the joints of an arm in view", "choice: as fast as a robot moves it")
    held_speed: float = quantity(0.03, "m/s", "of one that the robot holds", "choice: the grip says most of it")
    sinking_speed: float = quantity(
        0.06, "m/s", "of one that was let go of", "choice: friction in its joints brakes it"
    )
    hidden_speed: float = quantity(0.003, "m/s", "of one that is neither seen nor held", "choice: small slips")
    recent_time: float = quantity(0.5, "s", "since it was seen or held, which still counts as now", "choice: two looks")
    sinking_time: float = quantity(
        15.0, "s", "since it was let go of, while it may sink", "choice: by trial, not recorded"
    )
    # one frame
    min_points: int = quantity(15, "1", "of skin that a fit has to explain", "choice: less is noise")
    iterations: int = quantity(5, "1", "of the fit to one frame", "choice: it starts where the arm was just now")
    reach: float = quantity(3.0, "1", "of the joints' deviation, within which they are looked for", "choice: 99.7 %")
    min_anchor: float = quantity(
        0.05,
        "m",
        "of the pull that keeps unseen joints where they were, standard deviation",
        "choice: a few frames' motion",
    )
    shoulder_deviation: float = quantity(
        0.02, "m", "of the shoulder joint as the arm moves", "choice: the trunk stays on the bed"
    )
    gate_range: tuple[float, float] = quantity(
        (0.05, 0.12), "m", "from an arm to its skin", "choice: an arm's width to that of an arm and a half"
    )
    # fits that are not believed
    min_explained: float = quantity(0.85, "1", "of the skin beside the trunk", "choice: the rest may be the robot's")
    max_cost: float = quantity(6.0, "1", "mean squared residual of a fit that is believed", "choice: noise gives 1")
    max_misfits: int = quantity(
        5, "1", "of fits in turn, at which the arm is looked for again", "choice: over a second"
    )
    max_surprise: float = quantity(
        40.0, "1", "squared Mahalanobis distance of a fit", "standard: chi square, 12 degrees of freedom, 99.99 %"
    )
    max_surprises: int = quantity(3, "1", "in turn, at which the arm did move", "choice: chance does not repeat")
    # what is known
    whole_deviation: float = quantity(
        0.04, "m", "of every joint, at which the first look has seen a whole arm", "choice: nothing of it was hidden"
    )
    known_variation: float = quantity(
        0.03, "1", "of lengths that were seen once, standard deviation", "choice: half of what adults differ by"
    )
    lost_deviation: float = quantity(
        0.10, "m", "of a joint, at which it counts as lost", "choice: a hand that is led by it would miss the arm"
    )
    confident_deviation: float = quantity(0.05, "m", "at which the confidence is 1/e", "choice: half of what is lost")
    grip_deviation: float = quantity(
        0.02, "m", "of the arm's axis from the middle of the fingers", "choice: they are wider than the arm"
    )
    # an arm that does not show where it was
    bare_range: tuple[float, float] = quantity(
        (0.8, 3.0), "1", "arm coordinate, where bare skin is looked for", "choice: clear of the sleeve at the shoulder"
    )
    bare_samples: int = quantity(23, "1", "of the axis where it is looked for", "choice: every 2 to 3 cm")
    skin_distance: float = quantity(
        0.09, "m", "along the view, within which skin at the axis is this arm's", "choice: two radii and some noise"
    )
    max_bare_share: float = quantity(0.2, "1", "of the axis, of an arm that is no longer there", "choice: chance hits")
    min_bare_share: float = quantity(0.5, "1", "of the axis, of an arm that is found elsewhere", "choice: half of it")
    view: SkinViewTuning = field(default_factory=SkinViewTuning)
    fit: ArmFitTuning = field(default_factory=ArmFitTuning)
    filter: ArmFilterTuning = field(default_factory=ArmFilterTuning)
    search: ArmSearchTuning = field(default_factory=ArmSearchTuning)


DEFAULT = ArmTrackerTuning()


class ArmTracker:
    """Shoulder, elbow, wrist and fingertip of one arm.

    Usage: `update` with every head frame, `update_grip` whenever the robot's hand holds the arm, `estimate`
    whenever the posture is needed.  Times are the world's clock and must not run backwards.
    """

    def __init__(
        self,
        side: Side,
        bed: np.ndarray,
        scale: float | None = None,
        *,
        tuning: ArmTrackerTuning = DEFAULT,
        head_tuning: HeadTuning = HEAD_DEFAULT,
        skin_tuning: SkinTuning = SKIN_DEFAULT,
    ) -> None:
        """Start without an estimate.

        Args:
            side: the person's own left or right.
            bed: (2, 3) lower and upper corner of the bed in the map [m].
            scale: body size relative to an adult of 174 cm; judged by the size of the head when omitted.
            tuning: numbers.
            head_tuning: numbers of the search for the head.
            skin_tuning: numbers of what counts as skin.
        """
        self.side: Side = side
        self._tuning, self._head_tuning, self._skin_tuning = tuning, head_tuning, skin_tuning
        self._bed = np.asarray(bed, dtype=float)
        self._scale = scale
        self._body: LyingBody | None = None  # stays where it lies, and is best seen before anything covers it
        self._filter: ArmFilter | None = None
        self._limb: Limb | None = None  # of an arm that was seen whole once
        self._lengths, self._shoulder = np.zeros(3), np.zeros(3)  # as they were seen
        self._seen = -np.inf  # when skin of this arm was last explained
        self._held = -np.inf  # when the robot last said that it holds it
        self._frame_stamp = -np.inf
        self._surprises = 0
        self._misfits = 0

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
        if self._filter is None or self._body is None:
            body = body_seen(frame, self._bed, self._scale, self._head_tuning, self._skin_tuning)
            return self._begin(frame, body, self._view(frame, body))
        if frame.stamp <= self._frame_stamp:
            return 0  # a picture seen twice is not new evidence
        self._frame_stamp = frame.stamp
        view = self._view(frame, self._body)
        self._filter.predict(frame.stamp, self._speed(frame.stamp))
        if self._filter.deviation.max() > self._tuning.lost_deviation:
            return self._find_again(frame, self._body, view)
        if len(view.points) < self._tuning.min_points:
            return 0
        fit = self._fit(view, self._filter, self._body)
        explained = fit.used >= self._tuning.min_explained * len(view.points) and fit.cost <= self._tuning.max_cost
        self._misfits = 0 if explained else self._misfits + 1
        if self._misfits >= self._tuning.max_misfits:
            return self._find_again(frame, self._body, view)
        if fit.used < self._tuning.min_points:
            return 0
        if self._filter.surprise(fit) > self._tuning.max_surprise:
            self._surprises += 1
            if self._surprises < self._tuning.max_surprises:
                return 0
            self._filter.admit_jump()
        self._surprises = 0
        self._filter.take_fit(fit)
        self._keep_lengths(self._filter)
        self._seen = frame.stamp
        return fit.used

    def look_afresh(self, frame: Frame, *, moved: bool = False) -> bool:
        """Look for the arm all over a picture in which it does not show where it was.

        Args:
            frame: the picture.
            moved: the arm is known to have moved, so that skin where it was says nothing.

        Returns:
            Whether it was found, with bare skin all along it; if not, nothing changes.
        """
        if self._filter is None or self._body is None or (self._limb is None and not moved):
            return False
        if not moved and self._bare_share(frame, self._filter.joints) > self._tuning.max_bare_share:
            return False
        try:
            fit = self._search(self._body, self._view(frame, self._body))
        except PerceptionFailure:
            return False
        if self._bare_share(frame, fit.joints) < self._tuning.min_bare_share:
            return False
        self._follow(fit, frame.stamp)
        return True

    def update_grip(
        self, time: float, point_in_map: np.ndarray, arm_coordinate: float, deviation: float | None = None
    ) -> None:
        """The robot's fingers hold the arm: its axis passes through a known point.

        Args:
            time: world clock [s].
            point_in_map: (3,) of the arm's axis between the fingers [m].
            arm_coordinate: where along the arm, 0 shoulder, 1 elbow, 2 wrist, 3 fingertip.
            deviation: standard deviation of the point; the tuning's if not given [m].

        Raises:
            PerceptionFailure: the arm has never been found.
        """
        if self._filter is None:
            raise PerceptionFailure(Problem.NOTHING_SEEN, f"{self.side} arm")
        point = np.asarray(point_in_map, dtype=float)
        self._filter.predict(time, self._speed(time))
        self._filter.turn_to(point, arm_coordinate)
        self._held = time
        self._filter.take_point(point, arm_coordinate, self._tuning.grip_deviation if deviation is None else deviation)
        self._keep_lengths(self._filter)

    def estimate(self, time: float) -> ArmPosture:
        """Posture at `time` [s], not before the last update.

        Raises:
            PerceptionFailure: never found (`NOTHING_SEEN`) or too uncertain (`ARM_LOST`).
        """
        if self._filter is None:
            raise PerceptionFailure(Problem.NOTHING_SEEN, f"{self.side} arm")
        self._filter.predict(time, self._speed(time))
        deviation = self._filter.deviation
        if deviation.max() > self._tuning.lost_deviation:
            raise PerceptionFailure(Problem.ARM_LOST, f"{self.side} arm")
        return ArmPosture(
            stamp=self._filter.time,
            confidence=math.exp(-deviation.max() / self._tuning.confident_deviation),
            side=self.side,
            points_in_map=self._filter.joints,
            deviation=deviation,
        )

    def _view(self, frame: Frame, body: LyingBody) -> SkinView:
        return skin_view(frame, self._bed, body, self.side, self._tuning.view, self._skin_tuning)

    def _speed(self, time: float) -> float:
        """How fast the joints may move at `time`, standard deviation [m/s]."""
        if time - self._seen < self._tuning.recent_time:
            return self._tuning.seen_speed
        if time - self._held < self._tuning.recent_time:
            return self._tuning.held_speed
        if time - self._held < self._tuning.sinking_time:
            return self._tuning.sinking_speed
        return self._tuning.hidden_speed

    def _fit(self, view: SkinView, state: ArmFilter, body: LyingBody) -> ChainFit:
        """Fit the arm near to where the filter says that it is."""
        home, reach = state.joints, self._tuning.reach * state.deviation
        home[0] = self._shoulder  # the trunk stays on the bed, and clothes hide the shoulder most of the time
        anchor = np.clip(reach, self._tuning.min_anchor, max(self._tuning.search.roam_nearby))
        anchor[0] = self._tuning.shoulder_deviation
        return fit_chain(
            view,
            state.joints,
            anchor=anchor,
            home=home,
            scale=body.scale,
            limb=self._limb,
            iterations=self._tuning.iterations,
            gate=float(np.clip(reach.max(), *self._tuning.gate_range)),
            tuning=self._tuning.fit,
        )

    def _bare_share(self, frame: Frame, joints: np.ndarray) -> float:
        """Share of an arm (4, 3) below the upper arm's middle at which a picture shows skin."""
        coordinates = np.linspace(*self._tuning.bare_range, self._tuning.bare_samples)
        axis = np.array([point_along(joints, float(coordinate)) for coordinate in coordinates])
        rows, columns, depth, inside = pixels_of(frame, axis)
        skin = surfaces_at(frame.rgb, rows, columns) == Surface.SKIN
        near = np.abs(frame.depth[rows, columns] - depth) < self._tuning.skin_distance
        return float((inside & skin & near).mean())

    def _search(self, body: LyingBody, view: SkinView) -> ChainFit:
        """Look for the arm where it was and everywhere beside the trunk."""
        return find_arm(
            view,
            body,
            self.side,
            limb=self._limb,
            last=None if self._filter is None else self._filter.joints,
            tuning=self._tuning.search,
            fit_tuning=self._tuning.fit,
        )

    def _begin(self, frame: Frame, body: LyingBody, view: SkinView) -> int:
        """Find the arm and follow it from there; nothing changes if it is not found."""
        fit = self._search(body, view)
        self._body = body
        self._follow(fit, frame.stamp)
        return len(view.points)

    def _find_again(self, frame: Frame, body: LyingBody, view: SkinView) -> int:
        """Start over where the arm is too uncertain to be followed; keep what there is if it is not seen."""
        try:
            return self._begin(frame, body, view)
        except PerceptionFailure:
            return 0

    def _follow(self, fit: ChainFit, stamp: float) -> None:
        """Follow the arm from a fit on; what was seen of the limb itself stays known."""
        self._filter = ArmFilter(fit, stamp, self._tuning.filter)
        if self._limb is None:
            # lengths as they are seen, between the fit and the prior, stay fixed from now on
            self._lengths = np.linalg.norm(np.diff(fit.joints, axis=0), axis=1)
            self._shoulder = fit.joints[0].copy()
            if self._filter.deviation.max() < self._tuning.whole_deviation:
                self._limb = Limb(
                    lengths=self._lengths, variation=self._tuning.known_variation, span=span_row(fit.joints)[1]
                )
        self._surprises = self._misfits = 0
        self._seen = self._frame_stamp = stamp

    def _keep_lengths(self, state: ArmFilter) -> None:
        state.take_lengths(self._lengths, None if self._limb is None else self._limb.span)
