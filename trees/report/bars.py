"""Stages and skills as bars over time: a drawing in SVG, written out, as a plotting library takes longer than the run.

Widths of words are not known where the page is shown, so room is left for letters of usual fonts.
"""

from __future__ import annotations

import html
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from .figures import FAULT, STATUS

if TYPE_CHECKING:
    from .timeline import Span

ROWS_MAX = 60  # skills drawn; a whole dressing run has 70 to 110
LETTERS = 60  # of a name that is written beside its bar; the longest of the package have 40
WIDTH, ROW, LETTER = 1000, 22, 6.4  # [px] of the drawing, from bar to bar, of a letter at most as a rule
BAR, MARK, FONT = 16, 3, 11  # [px] height of a bar, half the size of a failure's cross, of the letters
SLANT = 30  # of the names of faults [degrees]
TICKS_MAX = 10  # of the time axis
Bar = tuple[float, float, str]  # from, to [s] and status


def telling_skills(spans: Sequence[Span], most: int = ROWS_MAX) -> tuple[list[str], int]:
    """Names of the skills that are drawn, in order of their start, and how many are left out.

    Of too many, those that failed come before those that took longest: what decided a run may be its last skill.
    """
    took: dict[str, tuple[bool, float]] = {}
    for span in spans:
        failed, seconds = took.get(span.name, (False, 0.0))
        took[span.name] = failed or span.status == "FAILURE", seconds + span.t_end - span.t_start
    drawn = set(sorted(took, key=took.__getitem__, reverse=True)[:most])
    return [name for name in took if name in drawn], max(len(took) - most, 0)


def timeline(
    stages: Sequence[Mapping[str, Any]],
    spans: Sequence[Span],
    end: float,
    faults: Sequence[tuple[float, str]] = (),
) -> str:
    """Stages and skills as bars over time, failures and faults marked (SVG, for a page).

    Args:
        stages: of run.json.
        spans: of the skills, in order of their start.
        end: of the time axis [s].
        faults: that were played, when [s] and which.
    """
    rows: list[tuple[str, list[Bar]]] = []
    for stage in stages:
        if stage.get("t_start") is not None:
            stop = end if stage.get("t_end") is None else float(stage["t_end"])
            rows.append((str(stage.get("name")), [(float(stage["t_start"]), stop, str(stage.get("status")))]))
    first_skill = len(rows)
    names, left_out = telling_skills(spans)
    pieces: dict[str, list[Bar]] = {name: [] for name in names}
    for span in spans:
        if span.name in pieces:
            pieces[span.name].append((span.t_start, span.t_end, span.status.lower()))
    rows += pieces.items()
    marked = [(t, _shortened(which)) for t, which in faults]

    left = 12 + LETTER * max((len(_shortened(name)) for name, _ in rows), default=0)
    rise = math.sin(math.radians(SLANT)) * LETTER * max((len(which) for _, which in marked), default=0)
    top = (20 if left_out else 4) + rise
    bottom = top + ROW * len(rows)
    scale = (WIDTH - left - 12) / max(end, 1e-3)  # [px/s]

    parts = [*_axis(end, left, scale, top, bottom)]
    if left_out:
        told = f"skills that failed, and those that took longest; {left_out} more are left out"
        parts.append(_word(told, left, 13))
    for row, (name, bars) in enumerate(rows):
        middle = top + ROW * (row + 0.5)
        weight = ' font-weight="bold"' if row < first_skill else ""
        parts.append(_word(_shortened(name), left - 6, middle + 4, f'text-anchor="end"{weight}'))
        opacity = 1.0 if row < first_skill else 0.75
        for start, stop, status in bars:
            wide = scale * max(stop - start, 0.004 * end)
            parts.append(
                f'<rect x="{left + scale * start:.1f}" y="{middle - BAR / 2:.1f}" width="{wide:.1f}" height="{BAR}" '
                f'fill="{STATUS.get(status, STATUS["running"])}" fill-opacity="{opacity}"/>'
            )
        parts += [_cross(left + scale * stop, middle) for _, stop, status in bars if status == "failure"]
    for t, which in marked:
        parts += _fault(which, left + scale * t, top, bottom)
    return (
        f'<svg role="img" aria-label="stages and skills over time" viewBox="0 0 {WIDTH} {bottom + 36:.0f}" '
        f'font-family="sans-serif" font-size="{FONT}">{"".join(parts)}</svg>'
    )


def _axis(end: float, left: float, scale: float, top: float, bottom: float) -> Iterator[str]:
    """Lines at round times, and what they are."""
    step = _round_step(max(end, 1e-3) / TICKS_MAX)
    for n in range(int(end / step + 1e-9) + 1):
        x = left + scale * n * step
        yield f'<path d="M{x:.1f} {top:.1f}V{bottom + 4:.1f}" stroke="#e4e7ea"/>'
        yield _word(f"{n * step:g}", x, bottom + 16, 'text-anchor="middle"')
    yield f'<path d="M{left:.1f} {top:.1f}V{bottom:.1f}H{WIDTH - 12}" fill="none" stroke="#1d252c"/>'
    yield _word("time [s]", (left + WIDTH) / 2, bottom + 32, 'text-anchor="middle"')


def _round_step(least: float) -> float:
    """The least of 1, 2 and 5 times a power of ten that is not below `least`."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(factor * power for factor in (1, 2, 5, 10) if factor * power >= least * (1 - 1e-9))


def _cross(x: float, y: float) -> str:
    """Marks a failure."""
    strokes = f"M{x - MARK:.1f} {y - MARK:.1f}l{2 * MARK} {2 * MARK}m0 {-2 * MARK}l{-2 * MARK} {2 * MARK}"
    return f'<path d="{strokes}" stroke="#7d1f18" stroke-width="1.6"/>'


def _fault(which: str, x: float, top: float, bottom: float) -> Iterator[str]:
    """Marks a fault; its name slants away from the nearer edge."""
    yield f'<path d="M{x:.1f} {top:.1f}V{bottom:.1f}" stroke="{FAULT["color"]}" stroke-dasharray="1.5 2.5"/>'
    late = x > WIDTH / 2
    turn = f'transform="rotate({SLANT if late else -SLANT} {x:.1f} {top:.1f})"'
    anchor = "end" if late else "start"
    yield _word(which, x, top - 2, f'{turn} text-anchor="{anchor}" fill="{FAULT["color"]}"')


def _word(text: str, x: float, y: float, more: str = "") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}"{" " if more else ""}{more}>{html.escape(text)}</text>'


def _shortened(name: str) -> str:
    """A name that leaves room for what it names; a damaged record may have one of thousands of letters."""
    return name if len(name) <= LETTERS else f"{name[: LETTERS - 1]}\u2026"
