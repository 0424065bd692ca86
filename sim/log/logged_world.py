"""Any world, with a log of what passes: what it measured, what was seen, and what was really sent."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator
from pathlib import Path

from ..abilities import HasKinematics, SupportsFaults
from ..blame import OF_FOREIGN_CODE
from ..errors import CaretreeError
from ..observation_form import ObservationForm
from ..scripted.clock import SteppedClock
from ..world import Clock, Command, Frame, Observation, Side, World, WorldError
from . import messages
from .log_file import LogFile

PICTURE_PERIOD = 1.0  # [s] between two pictures of one camera
URDF = "robot.urdf"  # name of the attachment


def logged(inner: World, file: LogFile | None, rate: float | None = None) -> World:
    """A world like `inner` that writes into `file`.

    Args:
        inner: the world.
        file: of the log; whoever opened it closes it.  None writes nothing, and is for repeating a run that had one.
        rate: of the measurements [Hz]: they are taken between ticks too, while the tree waits; None for those alone
            that the tree asks for.  A simulated sensor then draws its noise more often: the run is another one.
    """
    kind = _LoggedWorldWithFaults if isinstance(inner, SupportsFaults) else LoggedWorld
    return kind(inner, file, rate)


@contextlib.contextmanager
def logged_into(inner: World, path: str | None, rate: float | None = None) -> Iterator[World]:
    """`logged` into a file of that path, which is finished in the end; `inner` itself where no path is given.

    Raises:
        MissingExtra: the package `mcap` is not installed.
        RecordError: the file is there already, or could not be written.
    """
    if path is None:
        yield inner
        return
    file = LogFile(Path(path))
    try:
        yield logged(inner, file, rate)
    finally:
        file.close()


class LoggedWorld(World):
    """A world that writes down what passes; see `logged`."""

    def __init__(self, inner: World, file: LogFile | None, rate: float | None = None) -> None:
        self.inner = inner
        self.room, self.robot = inner.room, inner.robot
        self.kinematics = inner.kinematics if isinstance(inner, HasKinematics) else None
        self.clock = inner.clock if rate is None else _sampled(self, inner.clock, 1.0 / rate)
        self._file = file
        self._measured = -float("inf")
        self._looked: dict[str, float] = {}
        self._observed, self._form = messages.Observed(self.robot), ObservationForm(self.robot)
        if file is not None:
            file.attach(messages.ROBOT, "application/json", messages.roles(self.robot))
            with contextlib.suppress(CaretreeError, OSError):  # a robot without its files, or known by name alone
                file.attach(URDF, "application/xml", self.robot.urdf())

    def observe(self) -> Observation:
        """What the world measures; written once for each time at which it was measured."""
        seen = self.inner.observe()
        if not self._form.fault(seen) and seen.time > self._measured:  # others are refused by whoever asks
            self._measured = seen.time
            self._write(seen.time, self._observed.messages(seen))
        return seen

    def look(self, camera: str) -> Frame:
        """A frame; one in `PICTURE_PERIOD` of each camera is written."""
        frame = self.inner.look(camera)
        if frame.stamp >= self._looked.get(camera, -float("inf")) + PICTURE_PERIOD:
            self._looked[camera] = frame.stamp
            self._write(frame.stamp, messages.looked(frame), at_once=True)  # a picture may be drawn over
        return frame

    def send(self, command: Command) -> Command:
        """Send a command; written as it was really sent."""
        sent = self.inner.send(command)
        now = self._now()
        self._write(now, [messages.sent(now, sent)])
        return sent

    def stop(self) -> None:
        """Stop first, write then."""
        self.inner.stop()
        now = self._now()
        self._write(now, [messages.stopped(now)])

    def close(self) -> None:
        """Release the inner world."""
        self.inner.close()

    def _now(self) -> float:
        """The world's time, or that of the last measurement where its clock has died: it is stopped nevertheless."""
        try:
            return float(self.clock.now())
        except OF_FOREIGN_CODE:
            return max(self._measured, 0.0)

    def _write(self, time: float, these: Iterable[messages.Message], *, at_once: bool = False) -> None:
        if self._file is not None:
            self._file.write(time, these, at_once=at_once)


class _LoggedWorldWithFaults(LoggedWorld):
    """Plays the faults of the inner world."""

    inner: SupportsFaults

    def fault_grip_slip(self, side: Side) -> None:
        self.inner.fault_grip_slip(side)

    def fault_move_person(self) -> None:
        self.inner.fault_move_person()


class _Sampling:
    """Waits in pieces, with a measurement after each."""

    def __init__(self, world: LoggedWorld, clock: Clock, period: float) -> None:
        self._world, self._clock, self._period = world, clock, period

    def now(self) -> float:
        return self._clock.now()

    def wait_until(self, time: float) -> None:
        """One piece: a wait may come back early where time passes by itself."""
        self._piece(time)

    def _piece(self, time: float) -> None:
        self._clock.wait_until(min(time, self._clock.now() + self._period))
        with contextlib.suppress(WorldError):  # whoever needs the measurement asks for it, and is told
            self._world.observe()


class _SteppedSampling(_Sampling, SteppedClock):
    """The same of a clock that stands still until somebody waits."""

    def wait_until(self, time: float) -> None:
        while self._clock.now() < time:
            before = self._clock.now()
            self._piece(time)
            if self._clock.now() <= before:
                return


def _sampled(world: LoggedWorld, clock: Clock, period: float) -> Clock:
    return (_SteppedSampling if isinstance(clock, SteppedClock) else _Sampling)(world, clock, period)
