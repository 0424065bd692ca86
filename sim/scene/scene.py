"""One seeded draw of the room: who lies where, which gown hangs how, where bed and rail stand."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..errors import CaretreeError
from ..world import RoomMap
from ..world_kind import EASY_KIND, WorldKind
from .difficulties import SIZES, stream
from .falling_arms import with_falling_arms
from .gown import GOWNS, HELD_OUT_GOWNS, GownMesh, GownSpec, build_gown
from .gown_file import read_gown
from .person_spec import LYING_ELEVATION, LYING_ROTATION, PERSONS, PersonSpec

BED_TOP = 0.60  # mattress surface above the floor [m]
BED_HALF = np.array((0.50, 1.00))  # half width and half length [m]
BED_THICKNESS = 0.12  # mattress and frame; below it the base of the robot fits like an over-bed table [m]
RAIL_HEIGHT = 1.55  # of the hook [m]
RAIL_NOMINAL = np.array((2.7, 0.4))  # [m]
RESOLUTION = 0.05  # of the occupancy map [m]


@dataclass(frozen=True, kw_only=True)
class Scene:
    """What differs from run to run.

    Attributes:
        seed: what it was drawn from.
        kind: how hard it was made.
        gown: cut and cloth.
        mesh: its rest shape.
        person: size, arm pose, joint stiffness.
        bed_xy: middle of the bed in the map frame, off the nominal place by at most 2 cm [m].
        rail_xy: the hook in the map frame [m].
        hang_vertex: vertex of the neckline, within 11 cm of its middle, that hangs on the hook.
        hang_yaw: direction in which the gown's outside faces, against the map's y [rad].
    """

    seed: int
    kind: WorldKind
    gown: GownSpec
    mesh: GownMesh
    person: PersonSpec
    bed_xy: tuple[float, float]
    rail_xy: tuple[float, float]
    hang_vertex: int
    hang_yaw: float


def _named(kind: str, name: str, table: dict) -> object:
    if name not in table:
        raise CaretreeError(f"unknown {kind} '{name}'; there are {', '.join(table)}")
    return table[name]


def named_gown(name: str) -> GownSpec:
    """The gown called `name` in `GOWNS` or `HELD_OUT_GOWNS`; a name that ends in .yaml is a gown file.

    Raises:
        CaretreeError: no such gown, or a file that cannot be used.
    """
    if name.endswith((".yaml", ".yml")):
        return read_gown(name).spec
    spec = HELD_OUT_GOWNS.get(name) or _named("gown", name, GOWNS)
    assert isinstance(spec, GownSpec)
    return spec


def draw_scene(seed: int, gown: str | None = None, person: str | None = None, kind: WorldKind = EASY_KIND) -> Scene:
    """Draw a scene; the same arguments give the same scene.

    Args:
        seed: not negative.
        gown: name in `GOWNS`, or path of a gown file; drawn when omitted.
        person: name in `PERSONS`; drawn when omitted.
        kind: its difficulties come on top; what else is drawn does not depend on them.

    Raises:
        CaretreeError: an unknown name, a bad gown file or a negative seed.
    """
    if seed < 0:
        raise CaretreeError(f"seed {seed} is negative; seeds are 0, 1, 2 ...")
    rng = np.random.default_rng([seed, 0])
    gown = gown or str(rng.choice(list(GOWNS)))
    person = person or str(rng.choice(list(PERSONS)))
    spec = named_gown(gown)
    who = _named("person", person, PERSONS)
    assert isinstance(who, PersonSpec)
    mesh = build_gown(spec)
    friction = rng.uniform(0.85, 1.15)
    who = replace(
        who,
        scale=who.scale * rng.uniform(0.98, 1.02),
        pose={"left": _arm_pose(rng, 0.50, 0.70), "right": _arm_pose(rng, 0.50, 0.75)},
        dry_friction=(who.dry_friction[0] * friction, who.dry_friction[1] * friction),
    )
    if kind.has("falling_arms"):
        who = with_falling_arms(who, stream(seed, "falling_arms"), float(BED_HALF[0]))
    if kind.has("skin_friction"):
        coefficient = stream(seed, "skin_friction").uniform(*SIZES.skin_friction.coefficient)
        who = replace(who, skin_friction=float(coefficient) / spec.friction)
    middle = len(mesh.collar) // 2
    return Scene(
        seed=seed,
        kind=kind,
        gown=spec,
        mesh=mesh,
        person=who,
        bed_xy=(float(rng.uniform(-0.02, 0.02)), float(rng.uniform(-0.02, 0.02))),
        rail_xy=(float(RAIL_NOMINAL[0] + rng.uniform(-0.1, 0.1)), float(RAIL_NOMINAL[1] + rng.uniform(-0.05, 0.05))),
        hang_vertex=int(mesh.collar[middle + rng.integers(-2, 3)]),
        hang_yaw=float(rng.uniform(-0.4, 0.4) + (np.pi if rng.random() < 0.5 else 0.0)),
    )


def _arm_pose(rng: np.random.Generator, low: float, high: float) -> tuple[float, float, float, float]:
    """Abduction between `low` and `high`, resting on the bed, elbow bent by 6 to 20 degrees towards the midline."""
    return float(rng.uniform(low, high)), LYING_ELEVATION, LYING_ROTATION, float(rng.uniform(0.10, 0.35))


def room_map() -> RoomMap:
    """The map made beforehand: nominal places, free space inflated by half of the base's width.

    Along the sides of the bed and at the middle of its head the base may come as near as its mast allows: its 0.31 m
    deck passes under the mattress, as an over-bed table does.
    """
    origin = np.array((-3.0, -3.0))
    xs = origin[0] + RESOLUTION * np.arange(int(7.0 / RESOLUTION))
    ys = origin[1] + RESOLUTION * np.arange(int(6.5 / RESOLUTION))
    x, y = np.meshgrid(xs, ys)
    half = 0.50  # the base is 0.96 m x 0.79 m [m]
    free = (x > origin[0] + half) & (x < xs[-1] - half) & (y > origin[1] + half) & (y < ys[-1] - half)
    near = 0.22  # of the base's middle to the mattress [m]
    at_head = (np.abs(x) < near) & (y < -BED_HALF[1] - near)
    free &= ~((np.abs(x) < BED_HALF[0] + near) & (np.abs(y) < BED_HALF[1] + half) & ~at_head)
    free &= ~((np.abs(x - RAIL_NOMINAL[0]) < 0.9) & (np.abs(y - RAIL_NOMINAL[1]) < 0.5))
    return RoomMap(
        free=free,
        origin=origin,
        resolution=RESOLUTION,
        waypoints={
            "start": (2.7, -1.5, np.pi / 2),
            "rail": (2.7, -0.35, np.pi / 2),
            "rail_back": (2.7, 1.15, -np.pi / 2),
            "lay": (0.8, 1.6, -np.pi / 2),
            "bed_right": (1.25, -0.25, np.pi),
            "bed_left": (-1.25, -0.25, 0.0),
            "bed_head": (0.0, -1.8, np.pi / 2),
        },
        bed=np.array(((-BED_HALF[0], -BED_HALF[1], BED_TOP - BED_THICKNESS), (BED_HALF[0], BED_HALF[1], BED_TOP))),
    )
