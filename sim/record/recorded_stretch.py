"""A stretch of a recorded run in which a hand holds something, cut out so that a model can go through it again."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from ..errors import RecordError
from ..known_robots import DEFAULT
from ..scene.person_spec import ARM_SEGMENTS, arm_part
from ..scene.scene import Scene, draw_scene
from ..world import SIDES, Side
from ..world_kind import EASY, WorldKind
from .measured import Measured, read_measured
from .record import RUN_FILE, TRUTH_FILE, read_finished_run
from .stored_arrays import stored_arrays

BEFORE = 2.0  # a stretch begins so long before the hand takes hold [s]
EMPTY = 1.0  # until so long before it, an open hand touches nothing [s]
MOVED = 0.015  # a hand that holds an arm has turned its joints by what friction gives before it slips [m]
OPENING = 0.2  # before the hand has let go, its fingers open [s]
FIRM = 31.0  # load from which an arm slips in fingers that hold it with 30 N; what comes then is not looked at [N]
SHORTEST = 1.0  # of a stretch that says something [s]
NEEDED = ("t", "arms", "holds_arm", "gripper_closed", "person_force", "vertices")


@dataclass(frozen=True, kw_only=True, eq=False)
class Held:
    """What each hand holds at each sample of a run.

    Attributes:
        part: (T, 2) index in `PERSON_PARTS` of the part of an arm, -1 none.
        cloth: (T, 2) bool.
    """

    part: np.ndarray
    cloth: np.ndarray


@dataclass(frozen=True, kw_only=True, eq=False)
class Stretch:
    """What was measured in a stretch, and where it began.

    Attributes:
        scene: of the run, as it was drawn: without the effects of a model file.
        gown, person: names of them, as the run was given.
        robot: what was measured in the stretch.
        held: what the hands held.
        hand: 0 left, 1 right: the one whose load is looked at.
        arms: (2, 4, 3) of the person where it begins [m].
        vertices: (V, 3) of the gown there [m]; None where no hand holds it.
        looked_at: (T,) bool, samples at which model and measurement are compared: while the hand moves what it holds
            and, where the record is long enough and no time was given, before, while it holds nothing.
    """

    scene: Scene
    gown: str | None
    person: str | None
    robot: Measured
    held: Held
    hand: int
    arms: np.ndarray
    vertices: np.ndarray | None
    looked_at: np.ndarray

    @property
    def held_arm(self) -> int:
        """The person's arm that the hand holds in it: 0 left, 1 right, -1 none."""
        part = int(self.held.part[:, self.hand].max(initial=-1))
        return -1 if part < 0 else int(part >= arm_part(1, 0))


def read_stretch(
    directory: Path, t0: float | None = None, t1: float | None = None, hand: Side | None = None
) -> Stretch:
    """The stretch of a record in which a hand holds an arm, or the gown.

    Args:
        directory: of the record.
        t0: from when on samples are looked at; the first hold of an arm, where neither time is given [s].
        t1: until when [s].
        hand: whose load is looked at; the one that holds, where nothing is said.

    Raises:
        RecordError: the record is missing, damaged or of another world, or no hand holds anything then.
    """
    (scene, gown, person), measured = _scene(directory), read_measured(directory)
    truth = stored_arrays(directory / TRUTH_FILE, NEEDED, ": it tells where arms and gown were")
    frame = np.clip(np.searchsorted(truth["t"], measured.t, side="right") - 1, 0, None)
    held = _held(truth, frame)
    holds = _holds_of(directory, measured.t, held, (t0, t1), hand)
    for hold in holds:
        first = int(np.searchsorted(measured.t, hold.start - BEFORE))
        last = int(np.searchsorted(measured.t, min(hold.end, np.inf if t1 is None else t1), side="right"))
        rows = slice(first, last)
        looked_at = _moving(_cut(measured, rows), hold, t0)
        if looked_at.any() and np.ptp(measured.t[rows][looked_at]) >= SHORTEST:
            break
    else:
        when = ", ".join(f"the {SIDES[h.hand]} hand at {h.start:.1f} s" for h in holds)
        raise RecordError(f"{directory}: what is held hardly moves within {FIRM:g} N ({when})")
    part, cloth = held.part[rows], held.cloth[rows]
    if t0 is None:
        looked_at |= (measured.t[rows] <= hold.start - EMPTY) & (part[:, hold.hand] < 0) & ~cloth[:, hold.hand]
    return Stretch(
        scene=scene,
        gown=gown,
        person=person,
        robot=_cut(measured, rows),
        held=Held(part=part, cloth=cloth),
        hand=hold.hand,
        arms=np.array(truth["arms"][frame[first]], float),
        vertices=np.array(truth["vertices"][frame[first]], float) if cloth.any() else None,
        looked_at=looked_at,
    )


@dataclass(frozen=True)
class _Hold:
    hand: int
    start: float
    end: float
    arm: bool

    def overlap(self, t0: float | None, t1: float | None) -> float:
        """How long it lasts within a span [s]."""
        return min(self.end, np.inf if t1 is None else t1) - max(self.start, -np.inf if t0 is None else t0)


def _moving(robot: Measured, hold: _Hold, t0: float | None) -> np.ndarray:
    """(T,) samples from which on the hand moves what it holds, until its fingers open or what it holds may slip."""
    t, place = robot.t, robot.pose_hand[:, hold.hand, :3]
    taken = int(np.searchsorted(t, hold.start))
    moved = np.linalg.norm(place - place[taken], axis=1) > (MOVED if hold.arm else 0.0)
    since = (np.flatnonzero(moved & (t > hold.start))[:1].tolist() or [len(t)])[0]
    out = (np.arange(len(t)) >= since) & (t >= (-np.inf if t0 is None else t0)) & (t < hold.end - OPENING)
    if hold.arm:
        load = np.linalg.norm(robot.wrench_hand[:, hold.hand, :3], axis=1)
        out &= np.maximum.accumulate(np.where(t < hold.start, 0.0, load)) < FIRM
    return out


def _holds_of(
    directory: Path, t: np.ndarray, held: Held, span: tuple[float | None, float | None], hand: Side | None
) -> list[_Hold]:
    """The times that a hand holds an arm, or in a given span anything, for long enough; one of an arm first."""
    t0, t1 = span
    hands = range(2) if hand is None else (SIDES.index(hand),)
    holds = [h for n in hands for h in _holds(t, held, n)]
    wanted = [h for h in holds if h.overlap(t0, t1) >= SHORTEST]
    if t0 is None and t1 is None:
        wanted = [h for h in wanted if h.arm]
    if not wanted:
        when = f" between {t0 or 0.0:g} and {t1:g} s" if t1 is not None else f" from {t0:g} s on" if t0 else ""
        there = ", ".join(f"{SIDES[h.hand]} {h.start:.1f} to {h.end:.1f} s" for h in holds) or "none"
        what = "an arm" if t0 is None and t1 is None else "anything"
        raise RecordError(f"{directory}: no hand holds {what} for {SHORTEST:g} s{when} (holds: {there})")
    return sorted(wanted, key=lambda h: (not h.arm, h.start))


def _holds(t: np.ndarray, held: Held, hand: int) -> list[_Hold]:
    """Every time a hand holds something, in order."""
    kind = np.where(held.part[:, hand] >= 0, held.part[:, hand] + 1, -held.cloth[:, hand].astype(int))
    edges = np.flatnonzero(np.diff(np.concatenate(([0], kind, [0]))))
    return [_Hold(hand, float(t[a]), float(t[b - 1]), bool(kind[a] > 0)) for a, b in pairwise(edges) if kind[a]]


def _held(truth: dict[str, np.ndarray], frame: np.ndarray) -> Held:
    """What the hands hold at the samples; the part of an arm is the one that the hand's load is on."""
    arm, force = np.asarray(truth["holds_arm"]), np.asarray(truth["person_force"])
    part = np.full(arm.shape, -1)
    for hand in range(2):
        edges = np.flatnonzero(np.diff(np.concatenate(([-1], arm[:, hand], [-1]))))
        for a, b in pairwise(edges):
            side = int(arm[a, hand])
            if side >= 0:
                first = arm_part(side, 0)
                on = np.median(force[a:b, first : first + len(ARM_SEGMENTS)], axis=0)
                part[a:b, hand] = first + int(np.argmax(on))
    return Held(part=part[frame], cloth=np.asarray(truth["gripper_closed"], bool)[frame])


def _cut(measured: Measured, rows: slice) -> Measured:
    """Those samples; the base's yaw without jumps by a whole turn, as it is interpolated."""
    names = ("t", "pose_hand", "wrench_hand", "gripper_opening", "arm_positions", "head_pan", "pose_base")
    cut = {name: getattr(measured, name)[rows] for name in names}
    x, y, yaw = cut["pose_base"].T
    return replace(measured, **{**cut, "pose_base": np.column_stack((x, y, np.unwrap(yaw)))})


def _scene(directory: Path) -> tuple[Scene, str | None, str | None]:
    run = read_finished_run(directory)
    given, seed = run.get("parameters"), run.get("seed")
    if not isinstance(given, dict) or not isinstance(seed, int):
        raise RecordError(f"{directory / RUN_FILE} is damaged: it has no seed or no parameters")
    if run.get("world") != "bullet":
        raise RecordError(f"{directory} was run on {run.get('world')!r}, only records of the bullet world can be used")
    if (robot := given.get("robot") or DEFAULT) != DEFAULT:
        raise RecordError(f"{directory} is of the robot {robot}, only records of {DEFAULT} can be used")
    gown, person = given.get("gown"), given.get("person")
    return draw_scene(seed, gown, person, WorldKind.named(given.get("world_kind", EASY))), gown, person
