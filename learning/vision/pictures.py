"""Pictures of states of the room, drawn by seed: look, light, camera and noise; the same seed gives the same bytes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...sim.bullet.backdrop import Backdrop
from ...sim.mechanics.kinematics import kinematics_of
from ...sim.render.appearance import Appearance
from ...sim.render.camera import CAMERA_VIEWS, camera_intrinsics, looking_at
from ...sim.render.camera_noise import add_sensor_noise
from ...sim.render.diorama import along
from ...sim.render.looks import PLAIN, PRINTED, RANDOM, TAPED, draw_look
from ...sim.render.solids import capsule_mesh
from ...sim.robot.baxter import BAXTER
from ...sim.scene.person_spec import Capsule, trunk_capsules
from ...sim.scene.scene import BED_TOP, RAIL_HEIGHT, room_map
from ...sim.world import SIDES, Frame
from .labels import Labels, label, strap_weights
from .states import RoomState

PARTS = ("train", "test", "heldout")
_LOOKS = {RANDOM: 0.8, PLAIN: 0.08, PRINTED: 0.07, TAPED: 0.05}  # of the pictures for training
_FROM = {  # where the base stands for a look at each kind of state
    "hung": ("rail", "rail_back"),
    "held": ("rail", "lay"),
    "laid": ("bed_right", "bed_left", "lay"),
    "worn": ("bed_left", "bed_right"),
}
_AWAY = np.array((60.0, 0.0, 0.0))  # where the robot of meshes stands while the one in the picture is of capsules
_OWN_ARMS = 0.6  # of the head's pictures for training, which show the robot's own arms, of meshes, as it sees them
_OWN_EYE = 0.7  # of the pictures for training of states whose robot's posture is known, which its own camera sees, ...
_OFF = (0.02, 0.03)  # ... moved and turned a little [m, rad], ...
_IN_VIEW = 0.1  # ... where it sees as much of the gown
_ARM_SPREAD = (0.05, 0.6)  # of the joints from the ready posture, in half of these and in the others [rad]
_MOST_ROBOT = 0.35  # of a picture, beyond which the robot is left out
_HAND_DISTANCE = (0.28, 0.85)  # of a hand's camera from what it looks at [m]
_AT_STRAP = 0.5  # of the hands' pictures for training of gowns that lie, which look for a strap to take it, ...
_STRAP_DISTANCE = (0.24, 0.45)  # ... from so far off [m]; `SleeveSearchTuning` looks from 0.29 and 0.42 m


# Of the robot: base (3,), arms (2, n), the head's pan, how far the hands are open (2,) [m, rad].
_Posture = tuple[np.ndarray, np.ndarray, float, np.ndarray]


@dataclass(frozen=True, kw_only=True)
class Picture:
    """A frame as a camera of the robot delivers it, and the truth about it.

    Attributes:
        frame: the picture.
        labels: at its resolution.
        state: what it shows.
        look: name in `LOOKS`, of gown and room.
    """

    frame: Frame
    labels: Labels
    state: RoomState
    look: str


@dataclass(frozen=True)
class _Still:
    """A person who is drawn and does nothing."""

    trunk: Mapping[str, Capsule]
    _radii: np.ndarray
    _arms: np.ndarray

    def radii(self) -> np.ndarray:
        """(2, 3) [m]."""
        return self._radii

    def arms(self) -> np.ndarray:
        """(2, 4, 3) [m]."""
        return self._arms


def chosen_states(states: Sequence[RoomState], part: str) -> list[RoomState]:
    """The states that a part of the data shows; cuts that are held out are in `heldout` alone.

    Args:
        states: all there are.
        part: one of `PARTS`.
    """
    from ...sim.scene.gown import HELD_OUT_GOWNS

    if part == "heldout":
        return [s for s in states if s.test and s.gown in HELD_OUT_GOWNS]
    return [s for s in states if s.test == (part == "test") and s.gown not in HELD_OUT_GOWNS]


def draw_picture(
    states: Sequence[RoomState],
    part: str,
    seed: int,
    number: int,
    *,
    look: str | None = None,
    skin: int | None = None,
    light: str | None = None,
    kind: str | None = None,
    camera: str | None = None,
    gown: bool = True,
) -> Picture:
    """Draw picture `number` of a seed.

    Args:
        states: those of `chosen_states`.
        part: one of `PARTS`.
        seed: of all pictures.
        number: of this one.
        look: name in `LOOKS`; None draws one, as training does.
        skin: tone of the Monk scale; None leaves it to the look.
        light: name in `LIGHTS`; None leaves it to the look.
        kind: of the state, one of `KINDS`; None takes any.
        camera: `head` or `left_hand`; None draws it.
        gown: whether there is one in the room.
    """
    rng = np.random.default_rng([seed, PARTS.index(part), number])
    kinds = sorted({s.kind for s in states})
    wanted = kind or str(rng.choice(kinds))
    fitting = [s for s in states if s.kind == wanted]
    state = fitting[int(rng.integers(len(fitting)))]
    look = look or str(rng.choice(list(_LOOKS), p=list(_LOOKS.values())))
    appearance = draw_look(look, rng, held_out=part == "heldout", skin=skin, light=light)
    camera = camera or ("head" if rng.random() < 0.5 else "left_hand")
    size, lens = CAMERA_VIEWS[camera][0], camera_intrinsics(camera)
    pose, base, own = _eye(state, part, camera, rng)
    robot = rng.random() < 0.8
    if part == "train" and base is not None and rng.random() < _OWN_ARMS:
        own = _own_arms(base, rng)
    room = _room(state, appearance, robot=robot and own is None, gown=gown, own=own)
    drawn = room.renderer.render(pose, size, lens)
    robots = [number for name, number in room.renderer.ids.items() if name.startswith(("object_", "robot_"))]
    if np.isin(drawn.ids, robots).mean() > _MOST_ROBOT:
        room = _room(state, appearance, robot=False, gown=gown)
        drawn = room.renderer.render(pose, size, lens)
    rgb, depth = add_sensor_noise(drawn, rng)
    hook = np.array((*state.scene.rail_xy, RAIL_HEIGHT)) if state.kind == "hung" else None
    mesh = state.scene.mesh
    labels = label(room.renderer, mesh, state.arms, hook, pose, lens, size, gown=gown)
    frame = Frame(camera=camera, stamp=0.0, rgb=rgb, depth=depth, intrinsics=lens, pose_camera_in_map=pose)
    return Picture(frame=frame, labels=labels, state=state, look=look)


def _eye(
    state: RoomState, part: str, camera: str, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray | None, _Posture | None]:
    """A camera (4, 4), the base (3,) below the head's, and how the robot of the state stands, where it is its own."""
    if part == "train" and rng.random() < _OWN_EYE:
        own = _own_eye(state, camera, rng)
        if own is not None:
            return own[0], None, own[1]
    if camera == "head":
        return *_head_pose(state, rng), None
    if part == "train" and state.kind in ("laid", "worn") and rng.random() < _AT_STRAP:
        return _strap_pose(state, rng), None, None
    return _hand_pose(state, rng), None, None


def _own_arms(base: np.ndarray, rng: np.random.Generator) -> _Posture:
    """The robot that a picture is taken by from its base (3,), its arms before it."""
    return base, BAXTER.ready + rng.normal(0.0, float(rng.choice(_ARM_SPREAD)), BAXTER.ready.shape), 0.0, np.zeros(2)


def _own_eye(state: RoomState, camera: str, rng: np.random.Generator) -> tuple[np.ndarray, _Posture] | None:
    """The head's camera (4, 4), or a hand's, where the robot of the state has it, and how the robot stands.

    None where its posture is not known, or the camera sees no gown.
    """
    if state.posture is None:
        return None
    base, arms, (pan, *opening) = state.posture[:3], state.posture[3:-3].reshape(2, -1), state.posture[-3:]
    eye = camera if camera == "head" else f"{rng.choice(SIDES)}_hand"
    pose = kinematics_of(BAXTER).pose_camera_in_map(eye, base, arms, float(pan)) @ _rolled(rng.normal(0.0, _OFF[1]))
    pose[:3, 3] += rng.normal(0.0, _OFF[0], 3)
    (width, height), (fx, fy, cx, cy) = CAMERA_VIEWS[eye][0], camera_intrinsics(eye)
    x, y, z = ((state.vertices - pose[:3, 3]) @ pose[:3, :3]).T
    with np.errstate(divide="ignore", invalid="ignore"):
        u, v = fx * x / z + cx, fy * y / z + cy
    seen = (z > 0.0) & (u > 0.0) & (u < width) & (v > 0.0) & (v < height)
    return (pose, (base, arms, float(pan), np.array(opening))) if seen.mean() > _IN_VIEW else None


def _room(
    state: RoomState,
    appearance: Appearance,
    *,
    robot: bool,
    gown: bool,
    own: _Posture | None = None,
) -> Backdrop:
    """The room of a state, ready to draw; with the state's `robot` of capsules, or with its `own` posture."""
    scene = state.scene
    person = _Still(
        trunk_capsules(scene.person, BED_TOP, scene.bed_xy), np.tile(scene.person.arm_radii, (2, 1)), state.arms
    )
    kinematics = kinematics_of(BAXTER)
    room = Backdrop(scene, appearance, person, kinematics)
    if robot:
        for k, capsule in enumerate(state.capsules):
            length = max(float(np.linalg.norm(capsule[3:6] - capsule[:3])), 1e-3)
            mesh = capsule_mesh(np.zeros(3), np.array((0.0, 0.0, length)), float(capsule[6]))
            room.add(f"link{k}", *mesh, appearance.colours["robot" if k % 2 else "robot_grey"])
            room.renderer.set_pose(f"object_link{k}", along(capsule[:3], capsule[3:6]))
    posture = own or (_AWAY, np.zeros((2, 7)), 0.0, np.zeros(2))
    room.update(state.vertices, state.arms, kinematics.configuration(*posture))
    if not gown:
        room.renderer.remove_cloth()
    return room


def _head_pose(state: RoomState, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """The head's camera (4, 4) where the robot may stand, a bit off, turned a bit aside; and the base (3,) below it."""
    places = room_map().waypoints
    x, y, yaw = places[str(rng.choice(_FROM[state.kind]))]
    if state.kind == "held":  # wherever the gown is, it is before the robot
        x, y = state.vertices[:, :2].mean(axis=0) - rng.uniform(0.5, 0.8) * np.array((np.cos(yaw), np.sin(yaw)))
    base = np.array((x, y, yaw)) + rng.uniform(-1, 1, 3) * (0.25, 0.25, 0.25)
    pose = kinematics_of(BAXTER).pose_camera_in_map("head", base, np.zeros((2, 7)), float(rng.uniform(-0.5, 0.5)))
    return pose @ _rolled(rng.normal(0.0, 0.03)), base


def _hand_pose(state: RoomState, rng: np.random.Generator) -> np.ndarray:
    """A hand's camera near the gown or an arm, from wherever a hand may look."""
    mesh = state.scene.mesh
    rims = [state.vertices[loop].mean(axis=0) for loop in mesh.loops.values()]
    corners = [state.vertices[c] for c in mesh.corners]
    places = [*rims, *corners, *corners, state.vertices[int(rng.integers(len(state.vertices)))]]
    if state.kind in ("laid", "worn"):
        places += [*state.arms[:, 1], *state.arms[:, 2]]
    target = np.asarray(places[int(rng.integers(len(places)))], float) + rng.normal(0, 0.05, 3)
    distance = rng.uniform(*_HAND_DISTANCE)
    if state.kind in ("hung", "held"):
        aside = rng.choice((-np.pi / 2, np.pi / 2)) + rng.uniform(-1.0, 1.0)
        up = rng.uniform(-0.35, 0.45)
        offset = np.array((np.cos(up) * np.cos(aside), np.cos(up) * np.sin(aside), np.sin(up)))
    else:
        offset = _above(rng)
    return looking_at(target + distance * offset, target) @ _rolled(rng.normal(0.0, 0.35))


def _strap_pose(state: RoomState, rng: np.random.Generator) -> np.ndarray:
    """A hand's camera above one of the straps, as far beside it as where it was told to be may be off."""
    target = strap_weights(state.scene.mesh, str(rng.choice(SIDES))) @ state.vertices + rng.normal(0, 0.05, 3)
    return looking_at(target + rng.uniform(*_STRAP_DISTANCE) * _above(rng), target) @ _rolled(rng.normal(0.0, 0.35))


def _above(rng: np.random.Generator) -> np.ndarray:
    """Unit vector (3,) from what lies on the bed to a hand's camera."""
    aside, up = rng.uniform(-np.pi, np.pi), rng.uniform(0.5, 1.5)
    return np.array((np.cos(up) * np.cos(aside), np.cos(up) * np.sin(aside), np.sin(up)))


def _rolled(angle: float) -> np.ndarray:
    """A turn (4, 4) about the optical axis [rad]."""
    turn = np.eye(4)
    turn[:2, :2] = ((np.cos(angle), -np.sin(angle)), (np.sin(angle), np.cos(angle)))
    return turn
