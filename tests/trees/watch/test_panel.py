"""The panel shows forces against their limits and sends only what has changed."""

from __future__ import annotations

import contextlib
import re
from types import SimpleNamespace

import numpy as np
from caretree.trees.watch.panel import COLOURS, SPAN, Curves, Panel


class Gui:
    """Keeps what is added and counts what is sent."""

    def __init__(self):
        self.handles = []

    def _add(self, **values):
        sent = []
        names = {"__setattr__": lambda handle, name, value: (sent.append(value), handle.__dict__.update({name: value}))}
        handle = type("Handle", (), names)()
        handle.__dict__.update(values, sent=sent)
        self.handles.append(handle)
        return handle

    def add_html(self, content):
        return self._add(content=content)

    def add_folder(self, label):
        return contextlib.nullcontext()

    def add_image(self, image, **options):
        return self._add(image=image, **options)


def test_curves_forget_what_is_long_past_and_draw_limits():
    curves = Curves({"stop": 18.0})
    for t in np.arange(0.0, 2 * SPAN, 0.5):
        curves.add(float(t), {"left": 3.0, "right": 20.0})
    curves.add(1.0, {"left": 99.0, "right": 99.0})
    assert curves.t[-1] - curves.t[0] <= SPAN
    assert len(curves.t) == len(curves.values["left"]) == len(curves.values["right"])
    drawn = curves.svg()
    assert "stop, 18 N" in drawn
    assert "left 3.0 N" in drawn
    heights = [
        float(y) for y in re.findall(r",([\d.]+)", re.search(rf'points="([^"]*)"[^>]*{COLOURS["right"]}', drawn)[1])
    ]
    assert max(heights) < float(re.search(r'y1="([\d.]+)"[^>]*dasharray', drawn)[1]), "20 N is above 18 N"
    assert "nan" not in Curves({"stop": 18.0}).svg()


def test_only_changes_are_sent():
    gui = Gui()
    panel = Panel(SimpleNamespace(gui=gui))
    for _ in range(3):
        panel.headline("<task>", ("dress", ""), 1.0, note="paused")
        panel.tree("tree")
    assert [len(handle.sent) for handle in gui.handles] == [1, 0, 1]
    assert "&lt;task&gt;" in gui.handles[0].content
    assert "paused" in gui.handles[0].content
    for k in range(2):
        panel.image("head", np.full((4, 4, 3), k, np.uint8), f"{k} s")
    assert gui.handles[-1].label == "1 s"
    assert gui.handles[-1].image.max() == 1
