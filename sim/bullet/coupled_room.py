"""The room of a run: gown, bed, person and robot, and how one step of them passes.

Two PyBullet clients run side by side.  The room (deformable) holds gown, bed and person; the robot has a rigid
client of its own, because a deformable world makes each of its steps several times dearer.  They meet at the
hands: a `Handle` in the room follows each hand, holds what the fingers took, and its load is put on the robot's
wrist; and where a link touches the person (`contact.py`).  The robot's links do not push the cloth (an assumption
named in docs/assumptions.md).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..bullet_client import direct_client
from ..effects.model_file import EffectModel
from ..mechanics.capsules import RobotCapsules
from ..mechanics.kinematics import kinematics_of
from ..mechanics.robot_model import RobotModel
from ..robot.body import JointReading, RobotBody
from ..scene.person_spec import trunk_capsules
from ..scene.scene import BED_TOP, Scene
from ..scripted.clock import SteppedClock
from ..stopwatch import Stopwatch
from ..world import SIDES
from .cloth import ClothBody
from .contact import Contact
from .engines import ClothEngine
from .fingers import Fingers
from .furniture import add_furniture
from .gown import Gown
from .grip import Grip
from .handle import Handle
from .objects import RoomObjects
from .person import Person
from .sleep import Sleep

TIME_STEP = 0.0025  # of the room [s]
ROBOT_STEPS = 2  # room steps per robot step
CONTROL_STEPS = 4  # room steps between two looks at the fingers
LOAD_STEPS = 8  # room steps between two readings of what hangs on them: PyBullet takes 0.1 ms to say where a cloth is


class CoupledRoom:
    """Two engines in step.

    Args:
        scene: what was drawn.
        effects: of a model file, that act on the gown.
        engine: what moves the cloth.
        robot: that stands in the room.
        stands: where its base is at first, x, y, yaw in the map [m, m, rad].
        time: of the world, which a step moves on.

    Attributes:
        scene: what was drawn; truth, not for skills.
        time: of the world.
        robot: what the robot is made of.
        kinematics: the robot's own model, which the planner and the guard may use.
        stopwatch: of the activities `bullet` (the two engines' own steps) and whatever is computed around them.
    """

    def __init__(
        self,
        scene: Scene,
        effects: EffectModel | None,
        *,
        engine: ClothEngine,
        robot: RobotModel,
        stands: tuple[float, float, float],
        time: SteppedClock,
    ) -> None:
        self.scene, self.time, self.robot = scene, time, robot
        self._engine = engine
        self.kinematics = kinematics_of(robot)
        self.stopwatch = Stopwatch()
        self._in_bullet = self.stopwatch.of("bullet")  # entered at every step
        self._steps = 0
        self._soft = self._engine.room(TIME_STEP)
        self._client: Any = self._soft.client
        self._gown, self._person = self._furnish(effects)
        self._cloth, self._hook = self._gown.cloth, self._gown.hook
        self._objects = RoomObjects(self._engine, self._soft, self._person, BED_TOP)
        self._sleep = Sleep(self._cloth, self._person, self._objects, TIME_STEP)
        self._capsules = RobotCapsules(self.kinematics)
        self._contact = Contact(self._capsules, self._person, ROBOT_STEPS * TIME_STEP, TIME_STEP)
        self._robot_client: Any = direct_client()
        self._robot = self._stand(stands)
        self._reading = self._robot.read()
        self._hands = self._robot.poses_hands_in_map()
        self._handles = [Handle(self._client, self._hands[n]) for n in range(2)]
        self._fingers = Fingers(
            [Grip(self._client, side, self._handles[n], self._cloth, self._person) for n, side in enumerate(SIDES)]
        )
        self._grips = self._fingers.grips

    def _furnish(self, effects: EffectModel | None) -> tuple[Gown, Person]:
        """Load gown, furniture and person, in an order on which the solver's last bits depend."""
        scene, plain = self.scene, self._engine.soft_bodies
        trunk = np.array([(*a, *b, r) for a, b, r in trunk_capsules(scene.person, BED_TOP, scene.bed_xy).values()])
        gown = Gown(self._engine, self._soft, scene, effects, trunk)
        add_furniture(self._client, scene.bed_xy, plain=plain)
        person = Person(self._client, scene.person, BED_TOP, scene.bed_xy, plain=plain)
        gown.hang_up(self._client)
        return gown, person

    def _stand(self, pose_base_in_map: tuple[float, float, float], **posture: Any) -> RobotBody:
        """Put the robot somewhere, arms ready unless `posture` says otherwise."""
        self._contact.forget()
        self._robot_client.resetSimulation()
        self._robot_client.setTimeStep(TIME_STEP * ROBOT_STEPS)
        return RobotBody(
            self._robot_client, np.array(pose_base_in_map), kinematics=self.kinematics, time=self.time.time, **posture
        )

    def close(self) -> None:
        """End both physics clients; twice is once."""
        for client in (self._client, self._robot_client):
            if client.isConnected():
                client.disconnect()

    def _take_off_hook(self) -> None:
        """Let the gown be put elsewhere."""
        self._gown.take_off_hook()

    def _stand_ready(self, pose_base_in_map: tuple[float, float, float]) -> None:
        """Put the robot somewhere, arms ready and hands empty."""
        self._robot = self._stand(pose_base_in_map)
        self._hands = self._robot.poses_hands_in_map()

    def _tell_where_it_lies(self) -> None:
        """Let sleep, proxy bodies and whatever else remembers it know where the gown has been put."""
        self._look_anew()
        self._gown.put_down(self._client, self._sleep.vertices)

    def _step(self) -> None:
        if self._steps % ROBOT_STEPS == 0:
            self._step_robot()
        elif not self._sleep.asleep:
            self._meet()
        if self._steps % CONTROL_STEPS == 0:
            self._update_fingers(self._reading)  # of this instant: every control step begins with one of the robot
            if not self._sleep.asleep:
                self._objects.watch(CONTROL_STEPS * TIME_STEP, self._fingers.held())
            self._rest()
            if not self._sleep.asleep:
                self._person.resist()
        if not self._sleep.asleep:
            self._step_room()
        self._steps += 1
        self.time.time = self._steps * TIME_STEP

    def _step_robot(self) -> None:
        self._meet()
        self._robot.apply_hand_forces({SIDES[n]: self._grips[n].load for n in self._fingers.holding()})
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
        self._person.stir(self.time.time)
        self._gown.apply_effects(self.time.time, self._grips)
        self._contact.push_arms()
        self._person.spring()
        with self._in_bullet:
            self._soft.step()
        for n in held:
            if self._grips[n].kind in ("arm", "object"):
                self._handles[n].feel(TIME_STEP if self._grips[n].kind == "object" else None)

    def _update_fingers(self, reading: JointReading) -> None:
        """Let closed fingers take, opened fingers release, loads be felt."""
        squeeze = self._contact.squeeze(self._hands)
        if self._steps % LOAD_STEPS == 0 and self._fingers.holding():
            cloth = self._hook.holds or any(grip.kind == "cloth" for grip in self._grips)
            vertices = self._vertices_now() if cloth else self._sleep.vertices
            self._fingers.watch(self._cloth, vertices)
            held = self._fingers.held().get(self._cloth.body, ())
            self._hook.watch(LOAD_STEPS * TIME_STEP, held, vertices)
        if self._fingers.meet(self._robot, reading, self._hands, squeeze, self._cloths, self._catches):
            self._wake()

    def _catches(self, grip: Grip, hand: np.ndarray, opening: float, force: float) -> bool:
        """Whether closing fingers now meet an arm or an object."""
        return grip.catch_arm(hand, opening, force) or grip.catch_object(self._objects, hand, opening, force)

    @property
    def _cloths(self) -> list[ClothBody]:
        return [cloth for cloth in (self._cloth, *self._objects.cloths.values()) if cloth.body >= 0]

    def _rest(self) -> None:
        """Let a gown and arms that lie still and that nobody holds or touches sleep."""
        if self._sleep.due(self._steps):
            busy = self._person.stirs or self._contact.on_arms or bool(self._fingers.holding())
            self._sleep.look(self._steps, busy)

    def _wake(self) -> None:
        self._sleep.wake()

    def _settle(self, duration: float) -> None:
        """Pass room time before the run: the gown comes to rest, and arms that fall do."""
        for step in range(round(duration / TIME_STEP)):
            self._hook.before_step()
            self._gown.apply_effects(self.time.time, self._grips)
            if self.scene.person.falls and step % CONTROL_STEPS == 0:
                self._person.resist()
            self._soft.step()
        self._look_anew()

    def _vertices_now(self) -> np.ndarray:
        """(V, 3) of the gown [m], read-only."""
        return self._sleep.vertices_at(self._steps)

    def _look_anew(self) -> None:
        """The gown has been put somewhere else, or has moved before the run."""
        self._sleep.look_anew()
