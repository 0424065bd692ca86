"""What stands beside the room in the browser: stage and time, tree, forces against limits, camera images."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

COLOURS = {"left": "#1f6fb2", "right": "#c8641b"}  # as in the report
SPAN = 30.0  # [s] of the forces shown
WIDTH, HEIGHT = 430, 150  # of the curves [px]
FIGURE = "font:12px system-ui,sans-serif"


@dataclass
class Curves:
    """Forces over time, as far back as they are shown.

    Attributes:
        limits: what it is -> limit [N].
    """

    limits: Mapping[str, float]
    t: list[float] = field(default_factory=list)
    values: dict[str, list[float]] = field(default_factory=lambda: {side: [] for side in COLOURS})

    def add(self, t: float, values: Mapping[str, float]) -> None:
        """Add one sample [N] by side; one at a time that was there already is left out."""
        if self.t and t <= self.t[-1]:
            return
        self.t.append(t)
        for side, value in values.items():
            self.values[side].append(value)
        while self.t[-1] - self.t[0] > SPAN:
            del self.t[0]
            for each in self.values.values():
                del each[0]

    def svg(self) -> str:
        """The curves with the limits as lines."""
        top = 1.15 * max([*self.limits.values(), *(max(each, default=0.0) for each in self.values.values())])
        end = self.t[-1] if self.t else 0.0

        def x(t: float) -> float:
            return 30 + (WIDTH - 40) * (1.0 - (end - t) / SPAN)

        def y(force: float) -> float:
            return HEIGHT - 16 - (HEIGHT - 26) * min(force / top, 1.0)

        parts = []
        for name, limit in self.limits.items():
            parts.append(
                f'<line x1="30" x2="{WIDTH - 10}" y1="{y(limit):.1f}" y2="{y(limit):.1f}" stroke="#c0433a" '
                f'stroke-dasharray="4 3"/><text x="34" y="{y(limit) - 3:.1f}" fill="#c0433a">'
                f"{html.escape(name)}, {limit:g} N</text>"
            )
        for side, values in self.values.items():
            points = " ".join(f"{x(t):.1f},{y(value):.1f}" for t, value in zip(self.t, values, strict=True))
            parts.append(f'<polyline points="{points}" fill="none" stroke="{COLOURS[side]}" stroke-width="1.5"/>')
        now = ", ".join(
            f'<tspan fill="{COLOURS[side]}">{side} {values[-1]:.1f} N</tspan>'
            for side, values in self.values.items()
            if values
        )
        parts.append(f'<text x="30" y="{HEIGHT - 3}">{now}</text>')
        parts.append(f'<text x="{WIDTH - 10}" y="{HEIGHT - 3}" text-anchor="end" fill="#66727d">{end:.1f} s</text>')
        return (
            f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="100%" style="{FIGURE}" font-size="11">'
            f'<line x1="30" x2="{WIDTH - 10}" y1="{y(0):.1f}" y2="{y(0):.1f}" stroke="#c4cad0"/>{"".join(parts)}</svg>'
        )


class Panel:
    """The parts of the page beside the room.

    Args:
        server: viser's.
    """

    def __init__(self, server: Any) -> None:
        self._gui = server.gui
        self._headline = server.gui.add_html("")
        self.controls = server.gui.add_folder("run")
        with server.gui.add_folder("forces on the hands"):
            self._forces = server.gui.add_html("")
        with server.gui.add_folder("tree"):
            self._tree = server.gui.add_html("")
        self._cameras = server.gui.add_folder("cameras")
        self._images: dict[str, Any] = {}
        self._shown: dict[int, str] = {}

    def headline(self, title: str, lines: Sequence[str], time: float, *, note: str = "") -> None:
        """Stage, skill and time."""
        mark = f'<span style="float:right;color:#b23a31;font-weight:600">{html.escape(note)}</span>' if note else ""
        rest = "".join(f'<div style="color:#66727d">{html.escape(line)}</div>' for line in lines if line)
        self._set(
            self._headline,
            f'<div style="font:14px/1.5 system-ui,sans-serif;padding:4px 12px">{mark}<b>{html.escape(title)}</b>'
            f'<div style="font-size:20px">{time:.1f} s</div>{rest}</div>',
        )

    def tree(self, content: str) -> None:
        """The tree, as HTML."""
        self._set(self._tree, f'<div style="max-height:46vh;overflow-y:auto;padding:0 8px">{content}</div>')

    def forces(self, content: str) -> None:
        """The curves, as SVG."""
        self._set(self._forces, f'<div style="padding:0 8px">{content}</div>')

    def image(self, name: str, rgb: np.ndarray, label: str) -> None:
        """What a camera saw, (H, W, 3) uint8."""
        if name not in self._images:
            with self._cameras:
                self._images[name] = self._gui.add_image(rgb, label=label, format="jpeg", jpeg_quality=80)
            return
        self._images[name].image = rgb
        self._images[name].label = label

    def _set(self, handle: Any, content: str) -> None:
        """Send what has changed."""
        if self._shown.get(id(handle)) != content:
            self._shown[id(handle)] = content
            handle.content = content
