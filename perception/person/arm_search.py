"""Finding an arm that is not known yet, or no longer: a fan of postures beside the trunk, the best of them fitted."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from ...sim.quantity import Quantities, quantity
from ...sim.world import Side
from ..errors import PerceptionFailure, Problem
from .arm_fit import DEFAULT as FIT_DEFAULT
from .arm_fit import ArmFitTuning, ChainFit, Limb, fit_chain
from .lying_body import LyingBody, side_sign
from .person_facts import PERSON
from .skin_view import SkinView


@dataclass(frozen=True, kw_only=True)
class ArmSearchTuning(Quantities):
    """Numbers of the search for an arm."""

    min_points: int = quantity(40, "1", "of skin beside the trunk", "choice: less is no arm")
    pitches: tuple[float, float] = quantity(
        (-6.0, 30.0), "degree", "above the horizontal, tried", "choice: at rest on the bed, and as a robot leaves it"
    )
    abductions: tuple[float, float, float] = quantity(
        (15.0, 40.0, 65.0), "degree", "from the trunk, tried", "choice: a fit covers 15 degrees to either side"
    )
    bends: tuple[float, float] = quantity(
        (0.0, 45.0), "degree", "of the elbow, tried where its bend is not known", "choice: straight and half bent"
    )
    roam_anywhere: tuple[float, float, float, float] = quantity(
        (0.03, 0.20, 0.30, 0.40),
        "m",
        "of shoulder, elbow, wrist and fingertip from one of these postures, standard deviation",
        "choice: half way to the next posture and beyond",
    )
    roam_nearby: tuple[float, float, float, float] = quantity(
        (0.03, 0.08, 0.10, 0.12),
        "m",
        "of shoulder, elbow, wrist and fingertip from where they were last, standard deviation",
        "choice: a third of that",
    )
    wide_gate: float = quantity(0.15, "m", "from an arm to its skin in the first fit", "choice: catches a neighbour")
    wide_iterations: int = quantity(15, "1", "of the first fit", "choice: it starts far off")
    narrow_gate: float = quantity(0.06, "m", "from an arm to its skin in the second fit", "choice: an arm's width")
    narrow_iterations: int = quantity(10, "1", "of the second fit", "choice: it starts near by")
    miss_cost: float = quantity(
        20.0, "1", "of skin that a fit does not explain, times its share", "choice: outweighs residuals"
    )
    min_improvement: float = quantity(
        0.3,
        "1",
        "of the cost, for another start to count as better",
        "choice: the earlier start stays unless another is clearly better",
    )
    min_explained: float = quantity(0.7, "1", "of the skin that the arm has to explain", "choice: most of it")
    max_shoulder_offset: float = quantity(
        0.10, "m", "of the fitted shoulder from where the head says that it is", "choice: more is another limb"
    )


DEFAULT = ArmSearchTuning()


def find_arm(
    view: SkinView,
    body: LyingBody,
    side: Side,
    *,
    limb: Limb | None = None,
    last: np.ndarray | None = None,
    tuning: ArmSearchTuning = DEFAULT,
    fit_tuning: ArmFitTuning = FIT_DEFAULT,
) -> ChainFit:
    """Find an arm by the skin beside the trunk.

    Args:
        view: the skin.
        body: whose arm it is.
        side: of the person.
        limb: what is known of this arm.
        last: (4, 3) shoulder, elbow, wrist and fingertip where they were last, tried first [m].
        tuning: numbers of the search.
        fit_tuning: numbers of the fits.

    Raises:
        PerceptionFailure: no arm explains the skin there.
    """
    if len(view.points) < tuning.min_points:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"{side} arm")
    shoulder = body.shoulder_in_map(side)
    bends = tuning.bends if limb is None else tuning.bends[:1]
    anywhere = np.array(tuning.roam_anywhere)
    starts = [
        (_posture(shoulder, side, body.scale, *np.deg2rad(angles)), anywhere)
        for angles in itertools.product(tuning.pitches, tuning.abductions, bends)
    ]
    if last is not None:
        starts.insert(0, (last, np.array(tuning.roam_nearby)))
    best: tuple[float, ChainFit, np.ndarray] | None = None
    for start, anchor in starts:
        fit = fit_chain(
            view,
            start,
            scale=body.scale,
            limb=limb,
            gate=tuning.wide_gate,
            anchor=anchor,
            iterations=tuning.wide_iterations,
            tuning=fit_tuning,
        )
        missed = 1 - fit.used / len(view.points)
        score = fit.cost + tuning.miss_cost * missed
        if best is None or score < best[0] - tuning.min_improvement:
            best = score, fit, anchor
    assert best is not None
    home = best[1].joints.copy()
    home[0] = shoulder  # which lies on the bed however the arm is raised
    fit = fit_chain(
        view,
        best[1].joints,
        scale=body.scale,
        limb=limb,
        gate=tuning.narrow_gate,
        home=home,
        anchor=best[2],
        iterations=tuning.narrow_iterations,
        tuning=fit_tuning,
    )
    explained = fit.used >= tuning.min_explained * len(view.points)
    if not explained or np.linalg.norm(fit.joints[0] - shoulder) > tuning.max_shoulder_offset:
        raise PerceptionFailure(Problem.NOTHING_SEEN, f"{side} arm")
    return fit


def _posture(shoulder: np.ndarray, side: Side, scale: float, pitch: float, abduction: float, bend: float) -> np.ndarray:
    """Joints (4, 3) of an arm raised by `pitch`, its forearm turned towards the body by `bend` [rad]."""
    flat, up, sign = math.cos(pitch), math.sin(pitch), side_sign(side)
    upper = np.array((sign * flat * math.sin(abduction), flat * math.cos(abduction), up))
    fore = np.array((sign * flat * math.sin(abduction - bend), flat * math.cos(abduction - bend), up))
    lengths = np.array(PERSON.arm_lengths) * scale
    elbow = shoulder + lengths[0] * upper
    wrist = elbow + lengths[1] * fore
    return np.array((shoulder, elbow, wrist, wrist + lengths[2] * fore))
