"""A finished run in the browser, with a time slider: `caretree view DIR`."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from ...sim.errors import CaretreeError
from ...sim.evaluate.arrays_file import read_arrays
from ...sim.record.record import TRACE_FILE, TRUTH_FILE, read_run
from ...sim.render.browser_room import BrowserRoom
from ...sim.render.recorded_room import NEEDED, OPTIONAL, RecordedRoom
from ...sim.world import SIDES
from ..guard.limits import DEFAULT
from ..report.looks import drawn, read_looks
from ..report.outline import outline_html, read_outline, states_at
from ..report.timeline import read_trace, spans_of
from .panel import SPAN, Curves, Panel
from .server import address, close_server, open_server

RATES = ("1", "2", "5", "10", "30")
PERIOD = 0.05  # [s] wall time between two pictures while it plays
LOOK_FOR = 4.0  # [s] a picture that a failure left is shown so long around it


class Playback:
    """The page of one record.

    Args:
        directory: the record, finished or cut short.
        port: to serve it on; None for the first free one.

    Attributes:
        url: where it is.
        end: of the record [s].

    Raises:
        CaretreeError: the record cannot be read, viser is not installed, or the port is taken.
    """

    def __init__(self, directory: Path, port: int | None = None) -> None:
        run = read_run(directory)
        self._events = read_trace(directory / TRACE_FILE)
        self._rows, self._spans = read_outline(directory, self._events), spans_of(self._events)
        self._looks = read_looks(directory)
        self._stages = [stage for stage in run.get("stages") or () if isinstance(stage, dict)]
        self._room, self._load = None, np.zeros((0, 2))
        if (directory / TRUTH_FILE).exists():  # a scripted world has none
            arrays = read_arrays(directory, (*NEEDED, "gripper_load"), OPTIONAL)
            self._room = RecordedRoom(run, arrays)
            self._load = np.linalg.norm(arrays["gripper_load"], axis=2)
        times = [event["t"] for event in self._events if isinstance(event.get("t"), (int, float))]
        self.end = max([*times, *(self._room.t[-1:] if self._room else ())], default=0.0)
        if not self.end > 0:
            raise CaretreeError(f"{directory} holds nothing to look at: no frame and no event after its beginning")
        self._server = open_server(f"{run.get('task')}, seed {run.get('seed')}", port)
        self.url = address(self._server)
        self._title = f"{run.get('task')}, seed {run.get('seed')}: {run.get('outcome') or 'cut short'}"
        self._lock = threading.Lock()
        self._playing = False
        self._panel = Panel(self._server)
        self._scene = BrowserRoom(self._server.scene)
        self._add_controls()
        self.show(0.0)

    def _add_controls(self) -> None:
        gui = self._server.gui
        with self._panel.controls:
            step = max(round(self.end / 2000, 2), 0.01)
            self.slider = gui.add_slider("time [s]", min=0.0, max=float(self.end), step=step, initial_value=0.0)
            self._button = gui.add_button("play")
            self._rate = gui.add_dropdown("times as fast", RATES, initial_value="5")
            failures = [span for span in self._spans if span.status == "FAILURE"]
            places = ["", *(f"{span.t_end:.1f} s {span.name}" for span in failures)]
            jump = gui.add_dropdown("go to failure", places, initial_value="")

        @self.slider.on_update
        def _(_: Any) -> None:
            self.show(float(self.slider.value))

        @self._button.on_click
        def _(_: Any) -> None:
            self._playing = not self._playing
            self._button.label = "pause" if self._playing else "play"

        @jump.on_update
        def _(_: Any) -> None:
            if jump.value:
                self.slider.value = float(jump.value.split(" ")[0])

    def play(self) -> NoReturn:
        """Serve the page until the program is interrupted."""
        last = time.monotonic()
        while True:
            time.sleep(PERIOD)
            now = time.monotonic()
            if self._playing:
                wanted = float(self.slider.value) + (now - last) * float(self._rate.value)
                self.slider.value = min(wanted, float(self.end))  # which shows it
                if wanted >= self.end:
                    self._playing, self._button.label = False, "play"
            last = now

    def close(self) -> None:
        """End the page."""
        close_server(self._server)

    def show(self, t: float) -> None:
        """Show the run at `t` [s]."""
        with self._lock:
            curves = Curves({"cloth: slow down": DEFAULT.cloth_load_slow, "stop": DEFAULT.cloth_load_stop})
            if self._room is not None:
                times = self._room.t
                index = int(np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(times) - 1))
                self._scene.show(t, self._room.at(index))
                for k in range(int(np.searchsorted(times, t - SPAN)), index + 1, 2):
                    curves.add(float(times[k]), dict(zip(SIDES, self._load[k].tolist(), strict=True)))
            self._panel.forces(curves.svg())
            self._panel.headline(self._title, (self._stage_at(t), self._skills_at(t)), t)
            self._panel.tree(outline_html(self._rows, states_at(self._events, t), folded=True))
            near = [look for look in self._looks if abs(look.t - t) < LOOK_FOR]
            if near:
                look = min(near, key=lambda each: abs(each.t - t))
                self._panel.image(
                    "failure", drawn(look), f"{look.camera.replace('_', ' ')} at the failure, {look.t:.1f} s"
                )

    def _stage_at(self, t: float) -> str:
        for stage in self._stages:
            first, last = stage.get("t_start"), stage.get("t_end")
            if isinstance(first, (int, float)) and first <= t and (not isinstance(last, (int, float)) or t < last):
                return str(stage.get("name"))
        return ""

    def _skills_at(self, t: float) -> str:
        return ", ".join(span.name for span in self._spans if span.t_start <= t < span.t_end)
