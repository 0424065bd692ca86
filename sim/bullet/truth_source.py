"""What the recorder is given: everything that is known about the room, frame by frame.  Skills never see it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..mechanics.capsules import RobotCapsules
from ..mechanics.quaternion import places
from ..record.truth import TruthFrame, TruthStatic
from ..robot.body import RobotBody
from ..scene.person_spec import PERSON_PARTS, face
from ..scene.scene import BED_TOP, Scene
from .contact import Contact
from .grip import Grip
from .hook import Hook
from .objects import RoomObjects
from .person import Person
from .person_force import ForceBalance


class TruthSource:
    """Reads the truth of one run.

    Args:
        scene: what was drawn.
        capsules: of the robot.
        person: the body.
        hook: that the gown hangs on at first.
        grips: of the left and the right hand.
        contact: between robot and person.
        objects: that a task has added.
    """

    def __init__(
        self,
        scene: Scene,
        capsules: RobotCapsules,
        person: Person,
        hook: Hook,
        grips: Sequence[Grip],
        contact: Contact,
        objects: RoomObjects | None = None,
    ) -> None:
        self._scene, self._capsules, self._person = scene, capsules, person
        self._hook, self._grips, self._contact = hook, grips, contact
        self._objects = objects
        self._balance = ForceBalance(person, scene.gown.mass, BED_TOP)

    def static(self) -> TruthStatic:
        """What stays the same for the whole run."""
        mesh, trunk = self._scene.mesh, self._person.trunk
        return TruthStatic(
            faces=mesh.faces,
            rest_vertices=mesh.vertices,
            loops=mesh.loops,
            arm_radii=self._person.radii(),
            person_parts=PERSON_PARTS,
            robot_capsule_names=self._capsules.names,
            person_capsules=np.array([(*a, *b, radius) for a, b, radius in trunk.values()]),
            person_capsule_names=tuple(trunk),
            bed_top=BED_TOP,
            face=face(self._scene.person, BED_TOP, self._scene.bed_xy),
            neckline=mesh.collar,
            object_faces={} if self._objects is None else self._objects.faces(),
        )

    def frame(self, time: float, vertices: np.ndarray, robot: RobotBody) -> TruthFrame:
        """Everything about this instant, with the peaks of the contact's forces.

        Args:
            time: world clock [s].
            vertices: (V, 3) of the gown [m].
            robot: as it stands now.
        """
        reading = robot.read()
        closed = np.array([grip.kind == "cloth" for grip in self._grips])
        loads = np.stack([grip.load if grip.kind == "cloth" else np.zeros(3) for grip in self._grips])
        on_arm = {grip.part: grip.load for grip in self._grips if grip.part is not None}
        force = self._balance.parts(time, vertices, -self._gown_load(loads) - self._hook.load(vertices), on_arm)
        if self._objects is not None:
            force = force + self._objects.part_force + self._objects.cloth_force(time, self._sheet_loads(loads))
        ends = self._capsules.ends(
            reading.pose_base_in_map, reading.arm_positions, reading.head_pan, reading.gripper_opening
        )
        return TruthFrame(
            t=time,
            vertices=vertices,
            arms=self._person.arms(),
            torso_front=self._person.torso_front(),
            gripper_pose=places(robot.poses_hands_in_map(reading)),
            gripper_closed=closed,
            gripper_load=loads,
            person_force=force + self._contact.part_peak,
            robot_capsules=self._capsules.rows(ends),
            holds_arm=np.array([grip.arm for grip in self._grips]),
            objects={} if self._objects is None else self._objects.states(),
        )

    def _gown_load(self, loads: np.ndarray) -> np.ndarray:
        """(3,) of `loads` (2, 3), what the gown puts on the hands [N]."""
        sheets = set() if self._objects is None else {cloth.body for cloth in self._objects.cloths.values()}
        gown = [
            load for grip, load in zip(self._grips, loads, strict=True) if not sheets or grip.cloth.body not in sheets
        ]
        return np.sum(gown, axis=0) if gown else np.zeros(3)

    def _sheet_loads(self, loads: np.ndarray) -> dict[int, np.ndarray]:
        """Body of a cloth -> (3,) of `loads` (2, 3), what it puts on the hands that hold it [N]."""
        found: dict[int, np.ndarray] = {}
        for grip, load in zip(self._grips, loads, strict=True):
            if grip.kind == "cloth":
                found[grip.cloth.body] = found.get(grip.cloth.body, np.zeros(3)) + load
        return found
