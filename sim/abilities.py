"""What a World may offer beyond the contract: each ability is a protocol, asked for with `isinstance`.

A hardware adapter needs none of them.  Whoever uses an ability says in one sentence what is missing where a world
does not have it, or does without.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Protocol, runtime_checkable

if TYPE_CHECKING:
    import numpy as np

    from .record.recorded_state import RecordedState
    from .record.recorder import Recorder
    from .render.camera import Renderer
    from .scene.objects import RoomObject
    from .stopwatch import Stopwatch
    from .world import Side


class HandKinematics(Protocol):
    """Forward kinematics of both arms, as far as a guard needs them."""

    def pose_hand_in_map(self, side: Side, q: np.ndarray, pose_base_in_map: np.ndarray) -> np.ndarray:
        """(4, 4) pose of a hand for joint angles `q` (7,) [rad] and a base at (3,) x, y, yaw [m, m, rad]."""
        ...


@runtime_checkable
class HasKinematics(Protocol):
    """A world that knows the robot's own model; for one without it the guard makes that of `World.robot`."""

    @property
    def kinematics(self) -> HandKinematics | None:
        """The model; None where a world that passes on another one's has got none."""
        ...


@runtime_checkable
class TakesJointVelocities(Protocol):
    """A simulated robot whose arms can be driven joint by joint, as drivers of real ones are."""

    def send_joint_velocities(self, side: Side, velocities: np.ndarray, duration: float) -> None:
        """Move the joints of an arm with `velocities` (n,) [rad/s] for `duration` [s], and then hold them.

        It replaces what the arm was doing.
        """
        ...


@runtime_checkable
class HasTickRate(Protocol):
    """A world in which so little happens by itself that its trees may be ticked less often than on others."""

    @property
    def tick_rate(self) -> float:
        """Ticks a second that suffice."""
        ...


@runtime_checkable
class HasTiming(Protocol):
    """A world that keeps account of its time."""

    @property
    def stopwatch(self) -> Stopwatch:
        """Of its activities, among them `cameras`, `physics` and `record`."""
        ...


@runtime_checkable
class SupportsRecording(Protocol):
    """A world with a ground truth and a spectator's camera, both for the record only."""

    def attach_recorder(self, recorder: Recorder, on_error: Callable[[Exception], None]) -> None:
        """Give every frame from now on to `recorder`.

        Args:
            recorder: of the run.
            on_error: told once when recording fails, or the display (`DisplayError`): the world's time goes on, as
                the robot may hold a person's arm.
        """
        ...


class RoomView(Protocol):
    """Shows the room to people, as it goes on."""

    def show(self, time: float, room: Renderer) -> None:
        """Show the room at `time` [s]."""
        ...


@runtime_checkable
class SupportsViewing(Protocol):
    """A world with a room that people can watch."""

    def attach_view(self, view: RoomView) -> None:
        """Show every frame from now on in `view`; an error of it is told like one of recording."""
        ...


@runtime_checkable
class SupportsFaults(Protocol):
    """A world that plays the faults that happen in physics rather than in sensors or commands."""

    def fault_grip_slip(self, side: Side) -> None:
        """What that hand holds slides out of it."""
        ...

    def fault_move_person(self) -> None:
        """The person stirs."""
        ...


@runtime_checkable
class SupportsRestart(Protocol):
    """A world that outlives whoever uses it, such as a simulated robot in another process."""

    def restart(self) -> None:
        """Bring it back to its beginning, before a run.

        Raises:
            WorldError: it cannot be brought back, as no real one can.
        """
        ...


@runtime_checkable
class SupportsForks(Protocol):
    """A world that is all in this process' memory: after a fork, each of the two processes has one of its own.

    One with threads, sockets, open files or a physics engine is none.
    """

    def slip_changes_nothing(self, side: Side) -> bool:
        """Whether that hand holds nothing that could slide out of it, so that such a fault would leave all as it is."""
        ...

    def tell_of_person(self, asked: Callable[[], None]) -> bool:
        """Call `asked` from now on before anybody asks where the person is; False where somebody may ask unnoticed."""
        ...


@runtime_checkable
class SupportsInitialStates(Protocol):
    """A world that can begin a run elsewhere than at its beginning, for stages that are tried alone."""

    @property
    def initial_states(self) -> Sequence[str]:
        """Names of the states in which a run may begin, the usual one first."""
        ...

    def set_initial_state(self, name: str) -> None:
        """Bring the world into one of `initial_states`.

        Raises:
            WorldError: there is no such state, or the run has begun.
        """
        ...


@runtime_checkable
class SupportsRecordedStates(Protocol):
    """A world that can begin a run where another one was: what it lost there can be tried again."""

    def set_recorded_state(self, state: RecordedState) -> None:
        """Bring the world to where it was.

        Raises:
            WorldError: the run has begun, or what was recorded is not in this world.
        """
        ...


@runtime_checkable
class SupportsObjects(Protocol):
    """A world that a task can furnish before the run: `scene(world, seed)` of a task is given one."""

    def add(self, item: RoomObject) -> None:
        """Put an object into the room.

        Raises:
            CaretreeError: there is one of that name, it cannot be loaded, or the run has begun.
        """
        ...

    def remove_gown(self) -> None:
        """Take the gown away, for tasks that need none: a run then costs a fraction.

        Raises:
            CaretreeError: the run has begun.
        """
        ...
