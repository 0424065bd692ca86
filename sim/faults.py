"""A world that misbehaves on cue: faults that begin when the tree reaches a given node and phase.

A fault is written FAULT@NODE:PHASE, for instance `grip_slip@pull along the arm:step`.  NODE is a skill's name,
PHASE is `start`, `step` (a later tick of it) or `cancel`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np

from .abilities import HasKinematics, SupportsFaults, SupportsForks
from .errors import CaretreeError
from .world import SIDES, Command, Frame, GripperOpening, Observation, SensorLost, Side, World

Fault = Literal[
    "grip_slip",
    "occlusion",
    "stale_frame",
    "force_spike",
    "lost_command",
    "person_moves",
    "camera_out",
    "dead_camera",
    "dead_sensor",
]
FAULTS: tuple[str, ...] = get_args(Fault)
PHASES: tuple[str, ...] = ("start", "step", "cancel")
IN_PHYSICS: tuple[str, ...] = ("grip_slip", "person_moves")  # the world itself has to play these
FOREVER = float("inf")
# How long each fault lasts [s]; 0 happens at once and is over.
DURATION: dict[str, float] = {
    "grip_slip": 0.0,
    "person_moves": 0.0,
    "occlusion": 3.0,
    "stale_frame": 3.0,
    "force_spike": 0.5,
    "lost_command": 1.0,
    "camera_out": 20.0,
    "dead_camera": FOREVER,
    "dead_sensor": FOREVER,
}
# The calls that it changes while it lasts, and `person`, the question where the person is.
FELT: dict[str, tuple[str, ...]] = {
    "grip_slip": (),
    "person_moves": ("person",),
    "occlusion": ("look",),
    "stale_frame": ("look",),
    "force_spike": ("observe",),
    "lost_command": ("send", "stop"),
    "camera_out": ("look",),
    "dead_camera": ("look",),
    "dead_sensor": ("observe",),
}
SPIKE = np.array((0.0, 0.0, -40.0, 0.0, 0.0, 0.0))  # [N], [N m] above every limit of a load
OCCLUDER = 0.25  # [m] distance of what stands before the camera
SETTLED = 30.0  # [s] after a fault was first felt; 93 of 100 safe stops of the dressing are over by then (measured)
CLOSED = 0.03  # [m] a hand sent to less than this is taken to hold something


@dataclass(frozen=True)
class FaultSpec:
    """What goes wrong, and when."""

    fault: str
    node: str
    phase: str

    def __str__(self) -> str:
        return f"{self.fault}@{self.node}:{self.phase}"


def parse_fault(text: str) -> FaultSpec:
    """The fault written in `text`.

    Raises:
        CaretreeError: it is not FAULT@NODE:PHASE, or names an unknown fault or phase.
    """
    fault, at, rest = text.partition("@")
    node, colon, phase = rest.rpartition(":")
    if not (at and colon and node):
        raise CaretreeError(f"fault {text!r} is not written FAULT@NODE:PHASE, for instance grip_slip@let go:start")
    if fault not in FAULTS:
        raise CaretreeError(f"unknown fault {fault!r}; there are {', '.join(FAULTS)}")
    if phase not in PHASES:
        raise CaretreeError(f"unknown phase {phase!r}; there are {', '.join(PHASES)}")
    return FaultSpec(fault, node, phase)


class FaultyWorld(World):
    """A world with faults; everything else passes through.

    `grip_slip` and `person_moves` happen in physics: the inner world has to support them (`SupportsFaults`).

    Args:
        inner: the world.
        faults: each begins the first time its node enters its phase.

    Attributes:
        begun: faults that have begun, with the time [s].
        felt: when each fault first changed something [s].

    Raises:
        CaretreeError: a fault happens in physics, and the inner world does not play such faults.
    """

    def __init__(self, inner: World, faults: Sequence[FaultSpec]) -> None:
        for spec in faults:
            if spec.fault in IN_PHYSICS and not isinstance(inner, SupportsFaults):
                raise CaretreeError(
                    f"{type(inner).__name__} cannot play {spec.fault}, which happens in physics; "
                    f"any world can play {', '.join(fault for fault in FAULTS if fault not in IN_PHYSICS)}"
                )
        self.inner = inner
        self.clock = inner.clock
        self.room = inner.room
        self.robot = inner.robot
        self.kinematics = inner.kinematics if isinstance(inner, HasKinematics) else None
        self.faults = tuple(faults)
        self.begun: list[tuple[FaultSpec, float]] = []
        self.felt: dict[str, float] = {}
        self._until: dict[str, float] = {}
        self._last_frame: dict[str, Frame] = {}
        self._dead_wrench: np.ndarray | None = None
        self._closed: Side = "left"
        moves = any(spec.fault == "person_moves" for spec in faults)
        self._moved = False
        self._told_of_person = moves and isinstance(inner, SupportsForks) and inner.tell_of_person(self._asked)

    def on_phase(self, node: str, phase: str) -> None:
        """Called by the runner just before a skill enters a phase."""
        for spec in self.faults:
            if spec.node == node and spec.phase == phase and all(spec is not done for done, _ in self.begun):
                self.begun.append((spec, self.clock.now()))
                self.begin(spec.fault)

    def begin(self, fault: str, since: float | None = None) -> None:
        """Have a fault begin, whatever the phase.

        Args:
            fault: which one.
            since: when it began [s], for one that nobody has felt yet; None for now.
        """
        if fault == "grip_slip":
            assert isinstance(self.inner, SupportsFaults)
            if not (isinstance(self.inner, SupportsForks) and self.inner.slip_changes_nothing(self._closed)):
                self._feel(fault)
            self.inner.fault_grip_slip(self._closed)
        elif fault == "person_moves":
            assert isinstance(self.inner, SupportsFaults)
            self._moved = True
            if since is not None or not self._told_of_person:
                self._feel(fault)
            self.inner.fault_move_person()
        self._until[fault] = (self.clock.now() if since is None else since) + DURATION[fault]

    def feels(self, fault: str, call: str, camera: str = "") -> bool:
        """Whether a fault, while it lasts, changes what one of the calls in `FELT` does here."""
        return call in FELT[fault] and (fault != "stale_frame" or camera in self._last_frame)

    @property
    def settled(self) -> bool:
        """Whether all faults were felt so long ago that the run goes on like any other."""
        now = self.clock.now()
        all_felt = bool(self.felt) and all(spec.fault in self.felt for spec in self.faults)
        return all_felt and now >= max(self.felt.values()) + SETTLED

    @property
    def slipping(self) -> Side:
        """The hand that a grip slips out of."""
        return self._closed

    def observe(self) -> Observation:
        """Proprioception, spiked or dead when told so."""
        seen = self.inner.observe()
        wrench = np.array(seen.wrench_hand_in_map, float)
        if self._active("force_spike"):
            wrench[SIDES.index(self._closed)] += SPIKE
        if self._active("dead_sensor"):
            self._dead_wrench = wrench if self._dead_wrench is None else self._dead_wrench
            wrench = self._dead_wrench
        return replace(seen, wrench_hand_in_map=wrench)

    def look(self, camera: str) -> Frame:
        """A frame: lost, old, half hidden, or as it is."""
        if self._active("dead_camera") or self._active("camera_out"):
            raise SensorLost(f"the {camera} camera gives no image")
        if camera in self._last_frame and self._active("stale_frame"):
            return self._last_frame[camera]
        frame = self.inner.look(camera)
        self._last_frame[camera] = frame
        return _occluded(frame) if self._active("occlusion") else frame

    def send(self, command: Command) -> Command:
        """Pass a command on, or lose it on the way without a word."""
        if isinstance(command, GripperOpening) and command.opening < CLOSED:
            self._closed = command.side
        return command if self._active("lost_command") else self.inner.send(command)

    def stop(self) -> None:
        """Pass the stop on, or lose it like any command: whoever needs it must repeat it."""
        if not self._active("lost_command"):
            self.inner.stop()

    def close(self) -> None:
        """Release the inner world."""
        self.inner.close()

    def _active(self, fault: str) -> bool:
        """Whether a fault goes on, in a call that it changes."""
        if fault not in self._until:  # no clock is asked then: one that is gone must keep no stop from the robot
            return False
        active = self.clock.now() < self._until[fault]
        if active:
            self._feel(fault)
        return active

    def _asked(self) -> None:
        if self._moved:
            self._feel("person_moves")

    def _feel(self, fault: str) -> None:
        self.felt.setdefault(fault, self.clock.now())


def _occluded(frame: Frame) -> Frame:
    """The frame with something close in front of its middle."""
    height, width = frame.depth.shape
    rows, columns = slice(height // 10, height - height // 10), slice(width // 10, width - width // 10)
    rgb, depth = frame.rgb.copy(), frame.depth.copy()
    rgb[rows, columns] = 90
    # the camera's own noise stays, so that the image is hidden but not frozen
    hidden = depth[rows, columns]
    depth[rows, columns] = OCCLUDER + 0.01 * (hidden - hidden.mean())
    return replace(frame, rgb=rgb, depth=depth)
