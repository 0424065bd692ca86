"""Pictures of the report: measured and simulated overlaid, residual with the places found."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, kw_only=True)
class Curve:
    """One channel of one held-out episode.

    Attributes:
        title: channel and episode.
        unit: of the vertical axis.
        t: (T,) [s].
        measured, before, after: (T,) measured, model as given, model with the effects.
        floor: noise floor.
        spans: intervals found [s].
    """

    title: str
    unit: str
    t: np.ndarray
    measured: np.ndarray
    before: np.ndarray
    after: np.ndarray
    floor: float
    spans: tuple[tuple[float, float], ...] = ()


GAP = 3.0  # of the usual step, from which on nothing is drawn between two samples: what is between them is left out
INK, GREY, BLUE, RED = "#222222", "#9a9a9a", "#1f6fb4", "#c8452e"


def draw(curves: list[Curve], width: float = 7.4) -> str:
    """The curves as one PNG in a data URI: left measured against model, right what is left."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, 1.55 * len(curves) + 0.35), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(len(curves), 2, squeeze=False, sharex="row")
    for (left, right), c in zip(axes, curves, strict=True):
        thin = slice(None, None, max(1, len(c.t) // 1500))
        t, measured = c.t[thin], _broken(c.t[thin], c.measured[thin])
        left.plot(t, measured, color=INK, lw=1.0, label="measured")
        left.plot(t, _broken(t, c.before[thin]), color=RED, lw=0.9, label="model as given")
        left.plot(t, _broken(t, c.after[thin]), color=BLUE, lw=0.9, ls=(0, (4, 2)), label="with the effects")
        right.plot(t, measured - c.before[thin], color=RED, lw=0.8)
        right.plot(t, measured - c.after[thin], color=BLUE, lw=0.8)
        right.axhspan(-2 * c.floor, 2 * c.floor, color=GREY, alpha=0.3, lw=0)
        for a, b in c.spans[:40]:
            right.axvspan(a, b, color="#f2c14e", alpha=0.25, lw=0)
        left.set_title(c.title, fontsize=7.5, loc="left")
        left.set_ylabel(f"[{c.unit}]", fontsize=7)
        for axis in (left, right):
            axis.tick_params(labelsize=6.5, length=2)
            axis.spines[["top", "right"]].set_visible(False)
    axes[0][1].set_title("what is left; grey: noise floor, yellow: places found", fontsize=7.5, loc="left")
    lines, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(lines, labels, fontsize=6.5, frameon=False, ncol=3, loc="outside upper left")
    for axis in axes[-1]:
        axis.set_xlabel("time [s]", fontsize=7)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png")
    return "data:image/png;base64," + base64.b64encode(buffer.getvalue()).decode()


def _broken(t: np.ndarray, x: np.ndarray) -> np.ndarray:
    """`x` (T,) without the first sample after every gap in `t`, so that no line is drawn over it."""
    step = np.diff(t, prepend=t[0])
    return np.where(step > GAP * np.median(step), np.nan, x)
