"""What a simulated world knows and its robot must not: the geometry of one run, frame by frame.

Skills, trees and perception never import this module; the world writes it, the evaluator reads it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..errors import RecordError

LOOPS = ("armhole_left", "cuff_left", "armhole_right", "cuff_right")
OBJECT = "object_"  # begins the names of what a task has added
TORSO_POINTS_MIN = 100  # DESIGN.md: m >= 100


def _check_shape(name: str, array: np.ndarray, shape: tuple[int | None, ...]) -> None:
    """Raise RecordError unless `array` has `shape`; None allows any length."""
    given = np.shape(array)
    fits = len(given) == len(shape) and all(want in (None, got) for want, got in zip(shape, given, strict=True))
    if not fits:
        asked = ", ".join("any" if want is None else str(want) for want in shape)
        raise RecordError(f"{name} has shape {given}, but ({asked}) is asked for")


def _check_index(name: str, index: np.ndarray, count: int) -> None:
    """Raise RecordError unless `index` holds integers from 0 to `count` - 1."""
    if not np.issubdtype(np.asarray(index).dtype, np.integer):
        raise RecordError(f"{name} holds {np.asarray(index).dtype} values, but vertex numbers are integers")
    if np.size(index) and (np.min(index) < 0 or np.max(index) >= count):
        raise RecordError(f"{name} names vertices {np.min(index)} to {np.max(index)}, but there are 0 to {count - 1}")


@dataclass(frozen=True, kw_only=True)
class TruthStatic:
    """What stays the same for a whole run.

    Attributes:
        faces: (F, 3) int, triangles with outward winding.
        rest_vertices: (V, 3) rest shape [m].
        loops: name in `LOOPS` -> (n,) int, ordered so that the right-hand normal points from body to hand.
        arm_radii: (2, 3) capsule radii of upper arm, forearm and hand, left then right [m].
        person_parts: (k,) names of the body parts whose force is recorded.
        robot_capsule_names: (r,) names of the robot's links; those of a hand's fingers contain `finger`.
        person_capsules: (p, 7) ends and radius of head, trunk and legs, which do not move [m].
        person_capsule_names: (p,) names of them.
        bed_top: height of the mattress under the person [m].
        face: (6,) a point between mouth and nose and the outward normal there [m].
        neckline: (n,) int, vertices of the gown's neckline from end to end.
        object_faces: name -> (F, 3) int, triangles of each sheet that a task has added.

    Raises:
        RecordError: a shape, an index or a loop name is wrong.
    """

    faces: np.ndarray
    rest_vertices: np.ndarray
    loops: Mapping[str, np.ndarray]
    arm_radii: np.ndarray
    person_parts: tuple[str, ...]
    robot_capsule_names: tuple[str, ...]
    person_capsules: np.ndarray
    person_capsule_names: tuple[str, ...]
    bed_top: float
    face: np.ndarray
    neckline: np.ndarray
    object_faces: Mapping[str, np.ndarray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Reject a mesh that later frames could not be read against."""
        _check_shape("rest_vertices", self.rest_vertices, (None, 3))
        _check_shape("faces", self.faces, (None, 3))
        _check_shape("arm_radii", self.arm_radii, (2, 3))
        _check_index("faces", self.faces, len(self.rest_vertices))
        if set(self.loops) != set(LOOPS):
            raise RecordError(f"loops are named {sorted(self.loops)}, but {sorted(LOOPS)} are asked for")
        for name, loop in self.loops.items():
            _check_shape(f"loop_{name}", loop, (None,))
            _check_index(f"loop_{name}", loop, len(self.rest_vertices))
        _check_shape("person_capsules", self.person_capsules, (len(self.person_capsule_names), 7))
        _check_shape("face", self.face, (6,))
        _check_shape("neckline", self.neckline, (None,))
        _check_index("neckline", self.neckline, len(self.rest_vertices))

    def arrays(self) -> dict[str, np.ndarray]:
        """The arrays under the names they carry in truth.npz."""
        named = {f"loop_{name}": np.asarray(self.loops[name], dtype=np.int32) for name in LOOPS}
        return {
            "faces": np.asarray(self.faces, dtype=np.int32),
            "rest_vertices": np.asarray(self.rest_vertices, dtype=np.float32),
            **named,
            "arm_radii": np.asarray(self.arm_radii, dtype=np.float32),
            "person_parts": np.asarray(self.person_parts, dtype=np.str_),
            "robot_capsule_names": np.asarray(self.robot_capsule_names, dtype=np.str_),
            "person_capsules": np.asarray(self.person_capsules, dtype=np.float32),
            "person_capsule_names": np.asarray(self.person_capsule_names, dtype=np.str_),
            "bed_top": np.asarray(self.bed_top, dtype=np.float64),
            "face": np.asarray(self.face, dtype=np.float32),
            "neckline": np.asarray(self.neckline, dtype=np.int32),
            **{f"{OBJECT}{name}_faces": np.asarray(faces, np.int32) for name, faces in self.object_faces.items()},
        }


@dataclass(frozen=True, kw_only=True)
class TruthFrame:
    """One instant of a run, map frame.

    Attributes:
        t: world clock [s].
        vertices: (V, 3) garment vertices [m].
        arms: (2, 4, 3) left and right shoulder, elbow, wrist, fingertip [m].
        torso_front: (m, 6) points on the front of the torso and their outward normals [m].
        gripper_pose: (2, 7) position [m] and quaternion x, y, z, w of each hand.
        gripper_closed: (2,) bool, holds cloth.
        gripper_load: (2, 3) cloth load on each gripper [N].
        person_force: (k,) force on each body part, by cloth and by the robot [N].
        robot_capsules: (r, 7) axis ends and radius of every link above the base [m].
        holds_arm: (2,) int, which arm each hand holds: -1 none, 0 left, 1 right.
        objects: name -> (7,) position [m] and quaternion x, y, z, w of each rigid object that a task has added, (V, 3)
            vertices of each sheet [m].
    """

    t: float
    vertices: np.ndarray
    arms: np.ndarray
    torso_front: np.ndarray
    gripper_pose: np.ndarray
    gripper_closed: np.ndarray
    gripper_load: np.ndarray
    person_force: np.ndarray
    robot_capsules: np.ndarray
    holds_arm: np.ndarray
    objects: Mapping[str, np.ndarray] = field(default_factory=dict)

    def value(self, name: str) -> np.ndarray | float:
        """The array of this name in `row_type`."""
        return self.objects[name[len(OBJECT) :]] if name.startswith(OBJECT) else getattr(self, name)

    def row_type(self, static: TruthStatic) -> np.dtype:
        """The packed type of one frame on disk, after checking this frame against `static`.

        Raises:
            RecordError: an array has the wrong shape.
        """
        vertices, parts = len(static.rest_vertices), len(static.person_parts)
        links = len(static.robot_capsule_names)
        _check_shape("vertices", self.vertices, (vertices, 3))
        _check_shape("arms", self.arms, (2, 4, 3))
        _check_shape("torso_front", self.torso_front, (None, 6))
        points = len(self.torso_front)
        if points < TORSO_POINTS_MIN:
            raise RecordError(f"torso_front has {points} points, but at least {TORSO_POINTS_MIN} are asked for")
        _check_shape("gripper_pose", self.gripper_pose, (2, 7))
        _check_shape("gripper_closed", self.gripper_closed, (2,))
        _check_shape("gripper_load", self.gripper_load, (2, 3))
        _check_shape("person_force", self.person_force, (parts,))
        _check_shape("robot_capsules", self.robot_capsules, (links, 7))
        _check_shape("holds_arm", self.holds_arm, (2,))
        objects = {name: np.shape(state) for name, state in self.objects.items()}
        return frame_type(vertices=vertices, torso_points=points, parts=parts, links=links, objects=objects)


def frame_type(
    *, vertices: int, torso_points: int, parts: int, links: int, objects: Mapping[str, tuple[int, ...]] | None = None
) -> np.dtype:
    """Packed type of one frame: `vertices` V, `torso_points` m, `parts` k, `links` r, shapes of `objects` by name."""
    return np.dtype(
        [
            ("t", "<f8"),
            ("vertices", "<f4", (vertices, 3)),
            ("arms", "<f4", (2, 4, 3)),
            ("torso_front", "<f4", (torso_points, 6)),
            ("gripper_pose", "<f4", (2, 7)),
            ("gripper_closed", "?", (2,)),
            ("gripper_load", "<f4", (2, 3)),
            ("person_force", "<f4", (parts,)),
            ("robot_capsules", "<f4", (links, 7)),
            ("holds_arm", "i1", (2,)),
            *((f"{OBJECT}{name}", "<f4", shape) for name, shape in (objects or {}).items()),
        ]
    )
