"""A run in the browser while it goes on: `caretree run TASK --view`.

The run's own thread draws, between two ticks and where the world shows its frames; the buttons only leave word of what
somebody wants.  An error of the page asks for the safe stop, as one of the terminal does, and cannot skip it.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from ...sim.abilities import SupportsViewing
from ...sim.render.browser_room import BrowserRoom
from ...sim.render.camera import Renderer
from ...sim.render.plain_room import PlainRoom
from ...sim.scripted.clock import SteppedClock
from ...sim.world import SIDES, Observation, World
from ...skills.core.reasons import Reason
from ..nodes.failures import failure_of
from ..report.looks import Witness, drawn
from ..report.outline import State, outline_html, outline_of
from ..run.progress import Progress
from ..run.runner import Run
from .controls import Controls
from .panel import Curves, Panel
from .server import address, close_server, open_server

ROOM_PERIOD = 0.1  # [s] wall time between two pictures of the room
PANEL_PERIOD = 0.25  # [s] wall time between two states of the panel


class LiveView:
    """The page of one run.

    Args:
        title: of the page.
        port: to serve it on; None for the first free one.

    Attributes:
        url: where it is.
        controls: what was asked for on it.

    Raises:
        CaretreeError: viser is not installed, or the port is taken.
    """

    def __init__(self, title: str, port: int | None = None) -> None:
        self._server = open_server(title, port)
        self.url = address(self._server)
        self.controls = Controls()
        self._title = title
        self._panel = Panel(self._server)
        self._room = BrowserRoom(self._server.scene)
        self._next_room = self._next_panel = 0.0
        self._newest: tuple[float, Renderer] | None = None
        self._stage = self._skill = ""
        self._images: dict[str, float] = {}
        self._run: Run | None = None
        self._witness: Witness | None = None
        self._curves = Curves({})
        self._plain: PlainRoom | None = None

    def follow(self, run: Run, world: World, witness: Witness) -> None:
        """Show `run` on `world` from now on.

        Args:
            run: before its first tick.
            world: that it runs on, unguarded.
            witness: of what its cameras see.
        """
        self._run, self._witness = run, witness
        limits = run.limits
        self._curves = Curves({"cloth: slow down": limits.cloth_load_slow, "stop": limits.cloth_load_stop})
        self._rows = outline_of(run.root)
        self._nodes = {path: node for node, path in run.trace.paths.items()}
        if isinstance(world, SupportsViewing):
            world.attach_view(self)
        else:
            self._plain = PlainRoom(world.room)
        self._add_buttons(simulated=isinstance(world.clock, SteppedClock))

    def show(self, time: float, room: Renderer) -> None:
        """Show the room at `time` [s], unless it has just been shown."""
        self._newest = (time, room)
        if _now() >= self._next_room:
            self._next_room = _now() + ROOM_PERIOD
            self._room.show(time, room)

    def progress(self, progress: Progress) -> None:
        """Hear of a stage or skill that begins or ends."""
        if progress.kind == "stage":
            self._stage = progress.name if progress.status == "running" else f"{progress.name}: {progress.status}"
        else:
            self._skill = f"{progress.name}{f': {progress.message}' if progress.message else ''}"

    def before_tick(self) -> None:
        """Show how things stand, and wait where somebody has asked for it: the world's time waits too."""
        run = self._run
        if run is None:
            return
        seen = run.guard.seen
        if seen is not None:
            self._sample(seen)
        if _now() >= self._next_panel:
            self._refresh(run)
        self.controls.wait(run.context.now(), lambda: run.stopping, lambda: self._refresh_if_due(run))

    def finish(self, sentence: str) -> None:
        """Show the end."""
        if self._run is not None:
            self._skill, self._stage = sentence, "the run has ended"
            self._refresh(self._run)
        if self._newest is not None:
            self._room.show(*self._newest)
        self._server.flush()

    def close(self) -> None:
        """End the page."""
        close_server(self._server)

    def _add_buttons(self, *, simulated: bool) -> None:
        gui, controls = self._server.gui, self.controls
        with self._panel.controls:
            if simulated:  # a robot's time cannot be held still
                pause, step = gui.add_button("pause"), gui.add_button("step")
                pace = gui.add_checkbox("no faster than real time", initial_value=False)

                @pause.on_click
                def _(_: Any) -> None:
                    (controls.go_on if controls.paused else controls.pause)()
                    pause.label = "go on" if controls.paused else "pause"

                @step.on_click
                def _(_: Any) -> None:
                    controls.step()
                    pause.label = "go on"

                @pace.on_update
                def _(_: Any) -> None:
                    controls.live = bool(pace.value)

            stop = gui.add_button("stop safely", color="red")

            @stop.on_click
            def _(_: Any) -> None:
                stop.disabled = True
                if self._run is not None:
                    self._run.request_stop(Reason.INTERRUPTED, "the stop button of the view was pressed", "operator")

    def _sample(self, seen: Observation) -> None:
        load = np.linalg.norm(seen.wrench_hand_in_map[:, :3], axis=1)
        self._curves.add(seen.time, dict(zip(SIDES, load.tolist(), strict=True)))
        if self._plain is not None:
            self.show(seen.time, self._plain.at(seen))

    def _refresh_if_due(self, run: Run) -> None:
        if _now() >= self._next_panel:
            self._refresh(run)

    def _refresh(self, run: Run) -> None:
        self._next_panel = _now() + PANEL_PERIOD
        if self.controls.paused and self._newest is not None and self._next_room:
            self._room.show(*self._newest)
            self._next_room = 0.0
        note = "stopping" if run.stopping else "paused" if self.controls.paused else ""
        self._panel.headline(self._title, (self._stage, self._skill), run.context.now(), note=note)
        states = {}
        for path, node in self._nodes.items():
            if node.status.name != "INVALID":
                failure = failure_of(node) if node.status.name == "FAILURE" and not node.children else None
                words = failure.reason.value if failure else node.feedback_message if not node.children else ""
                states[path] = State(node.status.name, words)
        self._panel.tree(outline_html(self._rows, states, folded=True))
        self._panel.forces(self._curves.svg())
        for camera, look in dict(self._witness.looks if self._witness else {}).items():
            if self._images.get(camera) != look.t:
                self._images[camera] = look.t
                self._panel.image(camera, drawn(look), f"{camera.replace('_', ' ')}, {look.t:.1f} s")


def _now() -> float:
    """Wall clock [s]: how often is drawn has nothing to do with the world's time."""
    return time.monotonic()
