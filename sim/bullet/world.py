"""The simulated room: PyBullet soft-body gown, passive person, robot, cameras, behind the World contract.

Two PyBullet clients run side by side.  The room (deformable) holds gown, bed and person; the robot has a rigid
client of its own, because a deformable world makes each of its steps several times dearer.  They meet at the
hands: a `Handle` in the room follows each hand, holds what the fingers took, and its load is put on the robot's
wrist; and where a link touches the person (`contact.py`).  The robot's links do not push the cloth (an assumption
named in docs/assumptions.md).

Nothing outside `sim` may read `truth_frame`: skills see only `observe` and `look`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from ..bullet_client import direct_client
from ..effects.cloth.gown_patch import gown_effects, with_air
from ..effects.cloth.proxy_bodies import ClothPatch
from ..effects.dressing.dressing_model import changed_scene, load_cell_bias
from ..effects.effect import EffectError
from ..effects.model_file import EffectModel, load_model
from ..errors import CaretreeError
from ..mechanics.capsules import RobotCapsules
from ..mechanics.kinematics import kinematics_of
from ..mechanics.robot_model import RobotModel
from ..record.recorded_state import RecordedState
from ..record.recorder import Recorder
from ..record.truth import TruthFrame
from ..render.camera import Renderer
from ..render.looks import TAPED, draw_look
from ..robot.baxter import BAXTER
from ..robot.body import JointReading, RobotBody
from ..scene.gown import without_cloth
from ..scene.initial_state import InitialState
from ..scene.objects import RoomObject
from ..scene.person_spec import trunk_capsules
from ..scene.scene import BED_TOP, RAIL_HEIGHT, Scene, draw_scene, room_map
from ..scripted.clock import SteppedClock
from ..sensors.sensor_errors import SensorErrors
from ..stopwatch import Stopwatch, timed
from ..world import SIDES, Command, Frame, GripperOpening, Observation, Side, World, WorldError
from ..world_kind import EASY, WorldKind
from .backdrop import Backdrop
from .cameras import Cameras, Exposure
from .cloth import ClothBody, load_gown
from .contact import Contact
from .engines import BULLET, engine_named
from .fingers import Fingers
from .furniture import add_furniture
from .gown_placement import HOLDING_AT, dress_by_hand, hold_in_hands, holding, lay_by_hand, put_arms, put_on_by_hand
from .grip import Grip
from .handle import Handle
from .hook import Hook
from .objects import RoomObjects
from .person import Person
from .thinking_time import ThinkingTime
from .truth_source import TruthSource
from .watchers import RoomView, Watchers

TIME_STEP = 0.0025  # of the room [s]
ROBOT_STEPS = 2  # room steps per robot step
CONTROL_STEPS = 4  # room steps between two looks at the fingers
SETTLE = 2.0  # the gown hangs still before the clock starts [s]
SETTLE_RECORDED = 0.2  # what was recorded while it moved comes to rest [s]
WRENCH_NOISE = np.repeat((0.05, 0.005), 3)  # (6,) standard deviation of the wrist sensors [N], [N m]
SLEEP_MOVE = 0.004  # cloth that moves less than this ... [m]
SLEEP_TIME = 0.4  # ... in this time, and that nobody holds, rests: its physics waits [s]


class BulletWorld(World):
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
        self._engine = engine_named(engine)
        if model is not None and not self._engine.soft_bodies:
            raise CaretreeError(f"--model needs the engine {BULLET}: on {engine} no effects act")
        appearance = draw_look(look, np.random.default_rng([seed, 1]))
        scene = draw_scene(seed, gown, person, WorldKind.named(kind))
        self._effects, self.scene, bias = (None, scene, None) if model is None else _with_model(model, scene)
        if self.scene.gown.air_drag > 0 and self._engine.soft_bodies:  # springs have air of their own
            self._effects = with_air(self._effects, self.scene.gown.air_drag)
        self.room = room_map()
        self.time = SteppedClock(self._advance_to)
        self.clock = self.time
        self.robot = robot
        self.kinematics = kinematics_of(robot)
        self.stopwatch = Stopwatch()
        self._in_bullet = self.stopwatch.of("bullet")  # entered at every step
        self._noise = np.random.default_rng([seed, 2])
        self._errors = SensorErrors(seed, self.scene.kind, bias=bias, joints=robot.commanded_joints)
        self._thinking = ThinkingTime(seed, self.scene.kind, head_joint=robot.head_joint)
        self._steps = 0
        self._asleep = False
        self._moving_person: list[float] = []
        self._soft = self._engine.room(TIME_STEP)
        self._client: Any = self._soft.client
        self._build()
        self._arms = self._person.arms()
        self._objects = RoomObjects(self._engine, self._soft, self._person, BED_TOP)
        self._capsules = RobotCapsules(self.kinematics)
        self._contact = Contact(self._capsules, self._person, ROBOT_STEPS * TIME_STEP, TIME_STEP)
        self._robot_client: Any = direct_client()
        self._robot = self._stand(self.room.waypoints["start"])
        self._reading = self._robot.read()
        self._hands = self._robot.poses_hands_in_map()
        self._handles = [Handle(self._client, self._hands[n]) for n in range(2)]
        self._fingers = Fingers(
            [Grip(self._client, side, self._handles[n], self._cloth, self._person) for n, side in enumerate(SIDES)]
        )
        self._grips = self._fingers.grips
        self._backdrop = Backdrop(self.scene, appearance, self._person, self.kinematics)
        self._cameras = Cameras(self._expose, self._backdrop, self.kinematics, self._errors, self._noise)
        self._truth = self._truth_source()
        self._watchers = Watchers(self.truth_frame, self._draw, self._backdrop.diorama, self._cameras.last)
        self._settle(SETTLE)

    def _build(self) -> None:
        c, scene = self._client, self.scene
        turn = np.array(
            (
                (np.cos(scene.hang_yaw), -np.sin(scene.hang_yaw), 0.0),
                (np.sin(scene.hang_yaw), np.cos(scene.hang_yaw), 0.0),
                (0.0, 0.0, 1.0),
            )
        )
        hung = scene.mesh.vertices @ turn.T
        hook = np.array((*scene.rail_xy, RAIL_HEIGHT))
        trunk = np.array([(*a, *b, r) for a, b, r in trunk_capsules(scene.person, BED_TOP, scene.bed_xy).values()])
        start = hung - hung[scene.hang_vertex] + hook
        self._cloth: ClothBody
        self._patch: ClothPatch | None = None
        if self._effects is None:
            self._cloth = self._engine.cloth(self._soft, scene.mesh, start)
        else:
            self._cloth, self._patch = load_gown(
                self._soft, scene.mesh, start, self._effects, pinned={scene.hang_vertex}, capsules=trunk
            )
        add_furniture(c, scene.bed_xy, plain=self._engine.soft_bodies)
        self._person = Person(c, scene.person, BED_TOP, scene.bed_xy, plain=self._engine.soft_bodies)
        self._hook = Hook(c, self._cloth, hook, scene.hang_vertex)
        self._look_anew()

    def _stand(self, pose_base_in_map: tuple[float, float, float], **posture: Any) -> RobotBody:
        """Put the robot somewhere, arms ready unless `posture` says otherwise."""
        self._contact.forget()
        self._robot_client.resetSimulation()
        self._robot_client.setTimeStep(TIME_STEP * ROBOT_STEPS)
        return RobotBody(
            self._robot_client, np.array(pose_base_in_map), kinematics=self.kinematics, time=self.time.time, **posture
        )

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
        self._hook.release()
        if self._patch is not None:
            self._patch.detach()
            self._patch = None
        self._cloth.remove()
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
        if self._cloth.body < 0:
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
            if state == InitialState.GOWN_ON_PERSON:
                lay_by_hand(self._cloth, self._handles, self._soft.step, TIME_STEP)
            else:
                put_on = dress_by_hand if state == InitialState.GOWN_DRESSED else put_on_by_hand
                put_on(
                    self._cloth,
                    self._person,
                    self._handles,
                    self._soft.step,
                    TIME_STEP,
                    np.random.default_rng([self.scene.seed, 4]).uniform(size=2).tolist(),
                )
            beside = "bed_left" if state == InitialState.GOWN_WORN else "bed_right"
            self._stand_ready(self.room.waypoints[beside])
        self._tell_where_it_lies()

    def set_recorded_state(self, state: RecordedState) -> None:
        """Begin the run where another one was, at rest: the robot at the waypoint next to where it stood, arms ready.

        Raises:
            WorldError: the run has begun, or the state is of another gown.
        """
        if self._steps:
            raise WorldError("a recorded state can only be set before the run begins")
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

    def _take_off_hook(self) -> None:
        """Let the gown be put elsewhere."""
        self._hook.release()
        if self._patch is not None:  # proxy bodies cannot jump with the cloth
            self._patch.detach()

    def _stand_ready(self, pose_base_in_map: tuple[float, float, float]) -> None:
        """Put the robot somewhere, arms ready and hands empty."""
        self._robot = self._stand(pose_base_in_map)
        self._hands = self._robot.poses_hands_in_map()

    def _tell_where_it_lies(self) -> None:
        """Let sleep, proxy bodies and whatever else remembers it know where the gown has been put."""
        self._look_anew()
        if self._patch is not None:
            self._patch.attach(self._client, self._cloth.body, self._vertices)

    # -- senses --------------------------------------------------------------------------------------------

    def observe(self) -> Observation:
        """Joint sensors exact but for `SensorErrors`, wrist wrenches with noise."""
        now = self.clock.now()
        stands = self._robot.read()
        reading = self._errors.joints(stands, now)
        hands = self._hands.copy() if reading is self._reading else self._robot.poses_hands_in_map(reading)
        wrench = np.zeros((2, 6))
        for n in range(2):
            wrench[n, :3] = self._grips[n].load
        wrench += self._contact.wrench(self._hands)
        wrench += WRENCH_NOISE * self._noise.standard_normal((2, 6))
        wrench = self._errors.wrench(wrench, self._hands, hands)
        force = np.maximum(reading.gripper_force, self._contact.squeeze(self._hands))
        return Observation(
            time=now,
            arm_positions=reading.arm_positions.copy(),
            arm_velocities=reading.arm_velocities.copy(),
            arm_efforts=self._robot.efforts(stands),
            head_pan=reading.head_pan,
            pose_base_in_map=reading.pose_base_in_map.copy(),
            twist_base=reading.twist_base.copy(),
            gripper_opening=reading.gripper_opening.copy(),
            gripper_force=self._fingers.felt(force),
            wrench_hand_in_map=wrench,
            pose_hand_in_map=hands,
        )

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

    def close(self) -> None:
        """End both physics clients; twice is once."""
        for client in (self._client, self._robot_client):
            if client.isConnected():
                client.disconnect()

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

    def _step(self) -> None:
        if self._steps % ROBOT_STEPS == 0:
            self._step_robot()
        elif not self._asleep:
            self._meet()
        if self._steps % CONTROL_STEPS == 0:
            self._update_fingers(self._reading)  # of this instant: every control step begins with one of the robot
            if not self._asleep:
                self._objects.watch(CONTROL_STEPS * TIME_STEP, self._fingers.held())
            self._rest()
            if not self._asleep:
                self._person.resist()
        if not self._asleep:
            self._step_room()
        self._steps += 1
        self.time.time = self._steps * TIME_STEP

    def _step_robot(self) -> None:
        self._meet()
        for side, grip in zip(SIDES, self._grips, strict=True):
            if grip.kind != "nothing":
                self._robot.apply_hand_force(side, grip.load)
        self._contact.push_robot(self._robot)
        self._robot.update(self.time.time)
        with self._in_bullet:
            self._robot_client.stepSimulation()
        self._reading = reading = self._robot.read()
        self._contact.watch(self.time.time + ROBOT_STEPS * TIME_STEP, reading)
        self._hands = self._robot.poses_hands_in_map(reading)

    def _meet(self) -> None:
        """Let robot and person feel each other where they touch."""
        self._contact.meet(self.time.time, [grip.arm for grip in self._grips])
        if self._contact.on_arms:
            self._wake()

    def _step_room(self) -> None:
        held = self._fingers.holding()
        for n in held:
            self._handles[n].follow(self._hands[n])
        self._hook.before_step()
        self._objects.before_step()
        self._move_person()
        self._apply_effects()
        self._contact.push_arms()
        self._person.spring()
        with self._in_bullet:
            self._soft.step()
        for n in held:
            if self._grips[n].kind in ("arm", "object"):
                self._handles[n].feel(TIME_STEP if self._grips[n].kind == "object" else None)

    def _apply_effects(self) -> None:
        """Let the effects of a model file act."""
        if self._patch is None:
            return
        self._patch.apply(self.time.time)
        if self._patch.release_t is not None and self.time.time >= self._patch.release_t:
            holding = [grip for grip in self._grips if grip.kind == "cloth"]
            if holding:  # it slips once
                holding[0].release()
                self._patch.release_t = None

    def _update_fingers(self, reading: JointReading) -> None:
        """Let closed fingers take, opened fingers release, loads be felt."""
        squeeze = self._contact.squeeze(self._hands)
        if self._fingers.holding():
            cloth = self._hook.holds or any(grip.kind == "cloth" for grip in self._grips)
            vertices = self._vertices_now() if cloth else self._vertices
            self._fingers.watch(self._cloth, vertices)
            held = self._fingers.held().get(self._cloth.body, ())
            self._hook.watch(CONTROL_STEPS * TIME_STEP, held, vertices)
        if self._fingers.meet(self._robot, reading, self._hands, squeeze, self._cloths, self._catches):
            self._wake()

    def _catches(self, grip: Grip, hand: np.ndarray, opening: float, force: float) -> bool:
        """Whether closing fingers now meet an arm or an object."""
        return grip.catch_arm(hand, opening, force) or grip.catch_object(self._objects, hand, opening, force)

    @property
    def _cloths(self) -> list[ClothBody]:
        return [cloth for cloth in (self._cloth, *self._objects.cloths.values()) if cloth.body >= 0]

    def _rest(self) -> None:
        """Let a gown and arms that lie still and that nobody holds or touches rest, as rigid bodies sleep."""
        if self._asleep or self._steps % int(SLEEP_TIME / TIME_STEP):
            return
        vertices, arms = self._vertices_now(), self._person.arms()
        moved = max(float(np.abs(arms - self._arms).max()), self._objects.moved())
        moved = max(moved, float(np.abs(vertices - self._vertices).max(initial=0.0)))
        self._vertices, self._arms = vertices, arms
        busy = self._moving_person or self._contact.on_arms or self._fingers.holding()
        self._asleep = not busy and moved < SLEEP_MOVE and self._steps > 0

    def _wake(self) -> None:
        self._asleep = False

    def _settle(self, duration: float) -> None:
        """Pass room time before the run: the gown comes to rest, and arms that fall do."""
        for step in range(round(duration / TIME_STEP)):
            self._hook.before_step()
            self._apply_effects()
            if self.scene.person.falls and step % CONTROL_STEPS == 0:
                self._person.resist()
            self._soft.step()
        self._look_anew()

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

    def _vertices_now(self) -> np.ndarray:
        """(V, 3) of the gown [m], read-only: PyBullet is asked once between two steps, and for long."""
        if self._asleep:
            return self._vertices
        if self._looked_at != self._steps:
            self._looked_at, self._seen_vertices = self._steps, self._cloth.vertices()
        return self._seen_vertices

    def _look_anew(self) -> None:
        """The gown has been put somewhere else, or has moved before the run."""
        self._vertices, self._looked_at = self._cloth.vertices(), -1

    # -- faults that need physics --------------------------------------------------------------------------

    def fault_grip_slip(self, side: Side) -> None:
        """What a hand holds slides out of it."""
        self._grips[SIDES.index(side)].release()

    def fault_move_person(self) -> None:
        """The person stirs: both arms swing outwards by about 15 degrees within 0.6 s."""
        self._wake()
        self._moving_person = [self.time.time + 0.6]

    def _move_person(self) -> None:
        if self._moving_person:
            stirring = self.time.time < self._moving_person[0]
            self._person.swing(0.45 if stirring else 0.0)
            if not stirring:
                self._moving_person = []


def _with_model(given: str | EffectModel, scene: Scene) -> tuple[EffectModel | None, Scene, np.ndarray | None]:
    """What a model makes of a scene: effects on the gown, the scene, and (2, 3) what the hands' sensors add [N].

    Raises:
        CaretreeError: it cannot be read, or is for neither a gown nor a dressing.
    """
    try:
        model = given if isinstance(given, EffectModel) else load_model(given)
        if model.system != "dressing" and isinstance(given, str):
            return gown_effects(given), scene, None
        model.require("dressing")
        return None, changed_scene(scene, model), load_cell_bias(model)
    except EffectError as error:
        raise CaretreeError(f"--model {error}") from None
