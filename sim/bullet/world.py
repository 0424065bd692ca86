"""The dressing scene behind the World contract: a `CoupledRoom` with cameras, a noisy robot and a recorder.

Nothing outside `sim` may read `truth_frame`: skills see only `observe` and `look`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..effects.cloth.gown_patch import with_air
from ..effects.model_file import EffectModel
from ..errors import CaretreeError
from ..mechanics.robot_model import RobotModel
from ..record.recorded_state import RecordedState
from ..record.recorder import Recorder
from ..record.truth import TruthFrame
from ..render.camera import Renderer
from ..render.looks import TAPED, draw_look
from ..robot.baxter import BAXTER
from ..scene.gown import without_cloth
from ..scene.initial_state import InitialState
from ..scene.objects import RoomObject
from ..scene.scene import draw_scene, room_map
from ..scripted.clock import SteppedClock
from ..sensors.sensor_errors import SensorErrors
from ..stopwatch import timed
from ..world import SIDES, Command, Frame, GripperOpening, Observation, Side, World, WorldError
from ..world_kind import EASY, WorldKind
from .backdrop import Backdrop
from .cameras import Cameras, Exposure
from .coupled_room import TIME_STEP, CoupledRoom
from .engines import BULLET, engine_named
from .gown_placement import HOLDING_AT, hold_in_hands, holding, place_by_hand, put_arms
from .model_effects import with_model
from .proprioception import Proprioception
from .thinking_time import ThinkingTime
from .truth_source import TruthSource
from .watchers import RoomView, Watchers

SETTLE = 2.0  # the gown hangs still before the clock starts [s]
SETTLE_RECORDED = 0.2  # what was recorded while it moved comes to rest [s]


class BulletWorld(CoupledRoom, World):
    """One seeded run of the dressing scene.

    Args:
        seed: of everything that varies.
        gown: name of the gown, or path of a gown file; drawn from the seed when omitted.
        person: name of the person; drawn from the seed when omitted.
        model: model file of the gap workflow whose effects act on the gown, or on person, gown and sensors.
        kind: how hard the world is made, see `sim/world_kind.py`.
        look: of gown, person and room, see `sim/render/looks.py`.
        engine: what moves the cloth, see `engines.py`.
        robot: that stands in the room; Baxter by default.

    Attributes:
        scene: what was drawn; truth, not for skills.
        kinematics: the robot's own model, which the planner and the guard may use.
        stopwatch: of the activities `bullet` (the two engines' own steps), `physics` (what is computed around them),
            `cameras` and `record`.
        initial_states: names of the states in which a run may begin.

    Raises:
        CaretreeError: an unknown gown, person, kind, look or engine, a negative seed, an unusable model or gown file, a
            model file for an engine on which none acts, a gown too stiff for the time step.
    """

    initial_states = tuple(InitialState)

    def __init__(
        self,
        *,
        seed: int = 0,
        gown: str | None = None,
        person: str | None = None,
        model: str | EffectModel | None = None,
        kind: str = EASY,
        look: str = TAPED,
        engine: str = BULLET,
        robot: RobotModel = BAXTER,
    ) -> None:
        moved_by = engine_named(engine)
        if model is not None and not moved_by.soft_bodies:
            raise CaretreeError(f"--model needs the engine {BULLET}: on {engine} no effects act")
        appearance = draw_look(look, np.random.default_rng([seed, 1]))
        scene = draw_scene(seed, gown, person, WorldKind.named(kind))
        effects, scene, sensors = (None, scene, None) if model is None else with_model(model, scene)
        if scene.gown.air_drag > 0 and moved_by.soft_bodies:  # springs have air of their own
            effects = with_air(effects, scene.gown.air_drag)
        self.room = room_map()
        self.clock = SteppedClock(self._advance_to)
        super().__init__(
            scene, effects, engine=moved_by, robot=robot, stands=self.room.waypoints["start"], time=self.clock
        )
        self._noise = np.random.default_rng([seed, 2])
        self._errors = SensorErrors(seed, scene.kind, changes=sensors, joints=robot.commanded_joints)
        self._thinking = ThinkingTime(seed, scene.kind, head_joint=robot.head_joint)
        self._proprioception = Proprioception(self._grips, self._contact, self._fingers, self._errors, self._noise)
        self._backdrop = Backdrop(self.scene, appearance, self._person, self.kinematics)
        self._cameras = Cameras(self._expose, self._backdrop, self.kinematics, self._errors, self._noise)
        self._truth = self._truth_source()
        self._watchers = Watchers(self.truth_frame, self._draw, self._backdrop.diorama, self._cameras.last)
        self._settle(SETTLE)

    def _truth_source(self) -> TruthSource:
        return TruthSource(
            self.scene, self._capsules, self._person, self._hook, self._grips, self._contact, self._objects
        )

    def add(self, item: RoomObject) -> None:
        """Put an object into the room.

        Raises:
            WorldError: the run has begun.
            ObjectError: there is one of that name, or it cannot be loaded.
        """
        if self._steps:
            raise WorldError(f"object {item.name!r} comes too late: the run has begun")
        self._objects.add(item)
        self._backdrop.add(item.name, *self._objects.look(item.name))

    def remove_gown(self) -> None:
        """Take the gown away.

        Raises:
            WorldError: the run has begun.
        """
        if self._steps:
            raise WorldError("the gown can only be taken away before the run begins")
        self._gown.remove()
        self._look_anew()
        self.scene = replace(self.scene, mesh=without_cloth(self.scene.mesh))
        self._truth = self._truth_source()
        self._backdrop.renderer.remove_cloth()

    def set_initial_state(self, name: str) -> None:
        """Begin the run with the gown somewhere else than on its hook.

        Raises:
            WorldError: there is no such state, or the run has begun.
        """
        state = InitialState.named(name)
        if self._gown.gone:
            raise WorldError(f"no run begins with {name!r}: the task has taken the gown away")
        if self._steps:
            raise WorldError("an initial state can only be set before the run begins")
        if state == InitialState.GOWN_ON_HOOK:
            return
        self._take_off_hook()
        if state == InitialState.GOWN_IN_HANDS:
            self._robot = self._stand(HOLDING_AT, arm_positions=holding(self.kinematics), gripper_opening=0.0)
            self._hands = self._robot.poses_hands_in_map()
            hold_in_hands(self._cloth, self._grips, self._hands, self._soft.step, TIME_STEP)
        else:
            place_by_hand(
                state, self._cloth, self._person, self._handles, self._soft.step, TIME_STEP, seed=self.scene.seed
            )
            beside = "bed_left" if state == InitialState.GOWN_WORN else "bed_right"
            self._stand_ready(self.room.waypoints[beside])
        self._tell_where_it_lies()

    def set_recorded_state(self, state: RecordedState) -> None:
        """Begin the run where another one was, at rest: the robot at the waypoint next to where it stood, arms ready.

        Raises:
            WorldError: the run has begun, the state is of another gown, or there is no gown.
        """
        if self._steps:
            raise WorldError("a recorded state can only be set before the run begins")
        if not len(self.scene.mesh.faces):
            raise WorldError("a run without a gown cannot begin where another one was: its objects are not put there")
        asked, given = len(self._cloth.vertices()), len(state.vertices)
        if asked != given:
            raise WorldError(f"the recorded gown has {given} vertices, but this one has {asked}")
        if not self._hook.carries(state.vertices):
            self._take_off_hook()
        self._cloth.place(state.vertices)
        put_arms(self._person, state.arms)
        waypoints = self.room.waypoints.values()
        self._stand_ready(min(waypoints, key=lambda point: np.linalg.norm(state.robot - point[:2])))
        self._settle(SETTLE_RECORDED)
        self._tell_where_it_lies()

    # -- senses --------------------------------------------------------------------------------------------

    def observe(self) -> Observation:
        """What is felt now, with the sensors' errors and noise."""
        return self._proprioception.observe(self.clock.now(), self._robot, self._reading, self._hands)

    @timed("cameras")
    def look(self, camera: str) -> Frame:
        """What a camera sees now, or saw a moment ago, with the sensor's noise.

        Raises:
            SensorLost: there is no such camera.
        """
        frame = self._cameras.look(camera, self.clock.now())
        self._thinking.saw()
        return frame

    # -- commands ------------------------------------------------------------------------------------------

    def send(self, command: Command) -> Command:
        """Start a command, once it has been thought of; fingers stop at what is between them."""
        self._thinking.decided(command)
        self._advance_to(self.time.time)
        if not isinstance(command, GripperOpening):
            now = self.clock.now()
            return self._errors.told(self._robot.command(self._errors.executed(command, now)), now)
        return self._fingers.obey(command, self._robot)

    def send_joint_velocities(self, side: Side, velocities: np.ndarray, duration: float) -> None:
        """Move an arm joint by joint (n,) [rad/s] for `duration` [s]: for drivers, no part of the contract."""
        self._advance_to(self.time.time)
        self._robot.move_joints(side, velocities, duration)

    def stop(self) -> None:
        """Brake arms and base; the grippers keep their opening."""
        self._robot.stop()

    # -- time ----------------------------------------------------------------------------------------------

    @timed("physics")
    def _advance_to(self, time: float) -> None:
        time = max(time, self.time.time + self._thinking.spend())
        while self.time.time < time - 1e-9:
            self._cameras.pass_time(self.time.time)
            self._step()
            if self._watchers.due(self.time.time):
                with self.stopwatch.of("record"):
                    self._watchers.look(self.time.time)
                    self._contact.forget_peak()

    # -- truth: for the recorder only ----------------------------------------------------------------------

    def attach_recorder(self, recorder: Recorder, on_error: Callable[[Exception], None]) -> None:
        """Give every frame from now on to `recorder`, and whatever fails in showing or recording it to `on_error`."""
        self._watchers.record(recorder, self._truth.static(), on_error)

    def attach_view(self, view: RoomView) -> None:
        """Show every frame from now on in `view`."""
        self._watchers.show(view)

    def truth_frame(self) -> TruthFrame:
        """Everything that is known about this instant."""
        return self._truth.frame(self.time.time, self._vertices_now(), self._robot)

    def _draw(self) -> Renderer:
        vertices, arms, drawn = self._vertices_now(), self._person.arms(), self._objects.drawn()
        return self._backdrop.update(vertices, arms, self._robot.configuration(), drawn)

    def _expose(self) -> Exposure:
        arms, reading = self._person.arms(), self._robot.read()
        vertices, drawn = self._vertices_now(), self._objects.drawn()
        return Exposure(time=self.time.time, vertices=vertices, arms=arms, reading=reading, objects=drawn)

    # -- faults that need physics --------------------------------------------------------------------------

    def fault_grip_slip(self, side: Side) -> None:
        """What a hand holds slides out of it."""
        self._grips[SIDES.index(side)].release()

    def fault_move_person(self) -> None:
        """The person stirs: both arms swing outwards by about 15 degrees within 0.6 s."""
        self._wake()
        self._person.begin_to_stir(self.time.time)
