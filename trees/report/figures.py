"""The pictures of a report: curves and key frames, each as the bytes of an image file."""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...sim.evaluate.limits import (
    ROBOT_DEPTH_HEAD_MAX,
    ROBOT_DEPTH_MAX,
    STRETCH_MAX,
    STRETCH_P99_MAX,
    UPPER_ARM_MIN,
    WRIST_ABOVE_BED_MAX,
)
from ...sim.world import SIDES
from ..guard.limits import DEFAULT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...sim.evaluate.series import Series

WIDTH = 9.6  # [in] of every figure, so that their time axes line up
COLOURS = {"left": "#1f6fb2", "right": "#c8641b"}
PARTS = {"upper_arm": "-", "forearm": "--", "hand": ":", "arm": "-"}  # of the side's colour; the rest has its own
OTHERS = {"head": "#7b3fa0", "trunk": "#566573", "torso": "#566573", "legs": "#8d6e63"}
STATUS = {"success": "#4c9a5b", "failure": "#c0433a", "invalid": "#9aa3ad", "running": "#d9a53a"}
FAULT = {"color": "#7b3fa0", "linewidth": 1.0, "linestyle": ":"}
LIMIT = {"color": "#c0433a", "linewidth": 0.9, "linestyle": "--"}


def _figure(rows: int, height: float) -> tuple[Figure, list[Axes]]:
    """An empty figure with `rows` plots on one time axis."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    FigureCanvasAgg(figure)  # no display, no global state
    axes = list(np.atleast_1d(figure.subplots(rows, 1, sharex=True)))
    for axis in axes:
        axis.grid(axis="x" if rows == 1 else "both", color="#e4e7ea", linewidth=0.7)
        axis.set_axisbelow(True)
        axis.spines[["top", "right"]].set_visible(False)
        axis.tick_params(labelsize=8, length=3)
    return figure, axes


def _png(figure: Figure) -> bytes:
    buffer = io.BytesIO()
    with warnings.catch_warnings():  # names in a script that the font lacks become boxes
        warnings.filterwarnings("ignore", message="Glyph", category=UserWarning)
        figure.savefig(buffer, format="png", dpi=130)
    return buffer.getvalue()


def _line(axis: Axes, value: float, label: str) -> None:
    """A limit, named beside the plot, where no curve runs."""
    axis.axhline(value, **LIMIT)
    axis.annotate(
        label,
        (1.0, value),
        xycoords=("axes fraction", "data"),
        xytext=(3, 0),
        textcoords="offset points",
        va="center",
        fontsize=7,
        color=LIMIT["color"],
    )


def _both(axis: Axes, t: np.ndarray, curves: np.ndarray) -> None:
    for k, side in enumerate(SIDES):
        axis.plot(t, curves[:, k], color=COLOURS[side], linewidth=1.0, label=side)
    _legend(axis)


def _legend(axis: Axes) -> None:
    """Above the plot, where no curve runs."""
    axis.legend(fontsize=7, loc="lower left", bbox_to_anchor=(0.0, 0.97), frameon=False, ncols=4, borderpad=0.1)


def curves(series: Series, faults: Sequence[tuple[float, str]] = ()) -> bytes | None:
    """Those curves over time that hold something, with the limits drawn (PNG); None where none does.

    Loads, forces, hands, sleeves, stretch of the cloth and, where recorded, harm: a task without a gown has no sleeves.

    Args:
        series: of the run.
        faults: that were played, when [s] and which.
    """
    drawn = [draw for draw, has in _panels(series) if has]
    if not drawn or not len(series.t):
        return None
    figure, axes = _figure(len(drawn), 1.6 * len(drawn) + 0.3)
    for axis, draw in zip(axes, drawn, strict=True):
        draw(axis, series)
        for t, _ in faults:
            axis.axvline(t, **FAULT)
    axes[-1].set_xlabel("time [s]", fontsize=8)
    axes[-1].set_xlim(0, max(float(series.t[-1]), 1e-3))
    figure.align_ylabels()
    return _png(figure)


def _panels(series: Series) -> list[tuple[Callable[[Axes, Series], None], bool]]:
    """What can be drawn, and whether there is anything to show of it."""
    return [
        (_loads, bool(series.holds.any())),
        (_forces, bool(np.nan_to_num(series.person_force).any())),
        (_distances, bool(np.isfinite(series.distance).any())),
        (_speeds, bool(np.nan_to_num(series.speed).any())),
        (_sleeves, bool(np.nan_to_num(series.upper_arm).any())),
        (_stretch, bool(np.isfinite(series.stretch_max).any() and series.holds.any())),
        (_clearance, series.clearance is not None and bool(np.isfinite(series.clearance).any())),
        (_wrists, series.wrists is not None and bool(np.isfinite(series.wrists).any())),
    ]


def _loads(load: Axes, series: Series) -> None:
    _both(load, series.t, np.where(series.holds, series.load, np.nan))
    load.set_ylabel("cloth load [N]", fontsize=8)
    _line(load, DEFAULT.cloth_load_slow, "slow down")
    _line(load, DEFAULT.cloth_load_stop, "stop")
    load.set_ylim(0, 1.25 * max(DEFAULT.cloth_load_stop, float(np.nanmax(series.load, initial=0.0))))


def part_style(part: str) -> dict[str, Any]:
    """Colour and line of a part of the body: both arms as everywhere, by their side."""
    side, _, rest = part.partition("_")
    if side in COLOURS:
        return {"color": COLOURS[side], "linestyle": PARTS.get(rest, "-")}
    return {"color": OTHERS.get(part, "#2f7d5b"), "linestyle": "-"}


def _forces(force: Axes, series: Series) -> None:
    order = np.argsort(-np.nan_to_num(series.person_force).max(axis=0, initial=0.0))
    for part in order[:4]:
        name = series.person_parts[part]
        curve = series.person_force[:, part]
        force.plot(series.t, curve, linewidth=1.0, label=name.replace("_", " "), **part_style(name))
    force.set_ylabel("force on person [N]", fontsize=8)
    _line(force, DEFAULT.arm_load_stop, "stop, if it lasts")
    force.set_ylim(0, 1.25 * max(DEFAULT.arm_load_stop, float(np.nanmax(series.person_force, initial=0.0))))
    _legend(force)


def _distances(distance: Axes, series: Series) -> None:
    _both(distance, series.t, series.distance)
    distance.set_ylabel("hand to person [m]", fontsize=8)
    distance.set_ylim(0, 1.0)
    _line(distance, DEFAULT.near_person, "near")


def _speeds(speed: Axes, series: Series) -> None:
    near = np.where(series.distance < DEFAULT.near_person, series.speed, np.nan)
    for k, side in enumerate(SIDES):
        away = f"{side}, farther away"
        speed.plot(series.t, series.speed[:, k], color=COLOURS[side], linewidth=0.7, alpha=0.35, label=away)
        speed.plot(series.t, near[:, k], color=COLOURS[side], linewidth=1.2, label=f"{side}, near the person")
    speed.set_ylabel("hand speed [m/s]", fontsize=8)
    _line(speed, DEFAULT.hand_speed, "limit, near")
    speed.set_ylim(0, max(2.2 * DEFAULT.hand_speed, 1.1 * float(np.nanmax(series.speed, initial=0.0))))
    _legend(speed)


def _sleeves(sleeves: Axes, series: Series) -> None:
    _both(sleeves, series.t, series.upper_arm)
    sleeves.set_ylabel("armhole up the\nupper arm", fontsize=8)
    sleeves.set_ylim(0, 1.15)
    _line(sleeves, UPPER_ARM_MIN, "at least")


def _stretch(stretch: Axes, series: Series) -> None:
    stretch.plot(series.t, series.stretch_p99, color="#566573", linewidth=1.0, label="99th percentile")
    stretch.plot(series.t, series.stretch_max, color="#a9b4bd", linewidth=1.0, label="longest")
    stretch.set_ylabel("edge over rest", fontsize=8)
    _line(stretch, STRETCH_P99_MAX, "99th at most")
    _line(stretch, STRETCH_MAX, "longest at most")
    stretch.set_ylim(0.9, 1.12 * max(STRETCH_MAX, float(np.nanmax(series.stretch_max, initial=0.0))))
    _legend(stretch)


def _wrists(wrists: Axes, series: Series) -> None:
    assert series.wrists is not None
    _both(wrists, series.t, series.wrists)
    wrists.set_ylabel("wrist above\nmattress [m]", fontsize=8)
    _line(wrists, WRIST_ABOVE_BED_MAX, "at the end")
    wrists.set_ylim(0, max(1.5 * WRIST_ABOVE_BED_MAX, 1.1 * float(np.nanmax(series.wrists, initial=0.0))))


def _clearance(axis: Axes, series: Series) -> None:
    """From the robot to head and neck, and to the rest of the body, below the skin too."""
    assert series.clearance is not None
    t, gaps = series.t, series.clearance
    for k, (name, colour, limit) in enumerate(
        (("head and neck", "#7b3fa0", ROBOT_DEPTH_HEAD_MAX), ("rest of the body", "#566573", ROBOT_DEPTH_MAX))
    ):
        axis.plot(t, 1000 * gaps[:, k], color=colour, linewidth=1.0, label=name)
        _line(axis, -1000 * limit, "" if k else "deepest")
    axis.set_ylabel("robot to person\n[mm]", fontsize=8)
    axis.set_ylim(min(-1.5 * 1000 * ROBOT_DEPTH_MAX, 1100 * float(np.nanmin(gaps, initial=0.0))), 100)
    _legend(axis)


def jpeg(image: np.ndarray) -> bytes:
    """A key frame (H, W, 3) uint8 as JPEG."""
    from PIL import Image

    buffer = io.BytesIO()
    Image.fromarray(image).save(buffer, format="JPEG", quality=85)
    return buffer.getvalue()
