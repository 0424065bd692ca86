"""States of the room to take pictures of: where every vertex of the gown is, where the arms, where the robot.

They come from the simulator by seed, prepared for each state in which a run may begin, and from the truth of recorded
runs, which hold the states between: drawn aside, held in both hands, drawn over an arm.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...sim.errors import CaretreeError
from ...sim.evaluate.crossings import arm_line, crossing
from ...sim.scene.initial_state import InitialState
from ...sim.scene.scene import BED_TOP, RAIL_HEIGHT, Scene, draw_scene

if TYPE_CHECKING:
    from ...sim.bullet.world import BulletWorld

KINDS = ("hung", "held", "laid", "worn")
# What each state of the room shows, and for every how many rooms it is made.
PREPARED = {
    InitialState.GOWN_ON_HOOK: ("hung", 1),
    InitialState.GOWN_IN_HANDS: ("held", 1),
    InitialState.GOWN_ON_PERSON: ("laid", 2),
    InitialState.GOWN_WORN: ("worn", 3),
    InitialState.GOWN_DRESSED: ("worn", 3),
}
TEST_SEEDS = 5  # every fifth seed of the room is for tests: 104, 109, 114 ...
FRAMES = 60  # taken from a recorded run
HANGING = (1.5, 3.0, 4.5, 6.0, 8.0, 10.0, 12.0)  # when a gown on its hook is looked at, which a robot reaches in 6 [s]
HUNG_HIGH = 0.02  # of a gown that hangs on its hook, its highest vertex is this near to the hook's height at least [m]
LIES_LOW = 0.35  # above the mattress, below which the middle of a gown lies [m]


@dataclass(frozen=True, kw_only=True)
class RoomState:
    """One instant of a room.

    Attributes:
        kind: one of `KINDS`.
        seed: of the room.
        gown: name of the cut.
        person: name of the person.
        vertices: (V, 3) of the gown [m].
        arms: (2, 4, 3) of the person [m].
        capsules: (r, 7) of the robot's links, ends and radius [m].
        source: where it is from, in words.
        posture: (6 + 2 n,) of the robot: its base in the map, n joints of either arm, the head's pan, how far its hands
            are open [m, rad]; None where no robot had one.
    """

    kind: str
    seed: int
    gown: str
    person: str
    vertices: np.ndarray
    arms: np.ndarray
    capsules: np.ndarray
    source: str
    posture: np.ndarray | None = None

    @property
    def scene(self) -> Scene:
        """The room of its seed, with its gown and person."""
        return _scene(self.seed, self.gown, self.person)

    @property
    def test(self) -> bool:
        """Whether no training may see it."""
        return self.seed % TEST_SEEDS == TEST_SEEDS - 1


@lru_cache(maxsize=256)
def _scene(seed: int, gown: str, person: str) -> Scene:
    return draw_scene(seed, gown, person)


def prepared(seed: int, state: InitialState, gown: str | None = None) -> RoomState:
    """A state in which a run may begin, made by physics.

    Args:
        seed: of the room.
        state: what is prepared; worn costs 12 s, hung 2 s.
        gown: its cut; None leaves it to the seed.
    """
    from ...sim.bullet.world import BulletWorld

    world = BulletWorld(seed=seed, gown=gown)
    try:
        world.set_initial_state(state)
        return _state_of(world, PREPARED[state][0], seed, f"prepared {state}")
    finally:
        world.close()


def hanging(seed: int, instants: Sequence[float] = HANGING) -> list[RoomState]:
    """The gown on its hook as it comes to hang while nobody touches it: it rolls up, its corners before it.

    Args:
        seed: of the room.
        instants: when it is looked at [s]; a second costs about one.
    """
    from ...sim.bullet.world import BulletWorld
    from ...sim.waiting import wait

    world = BulletWorld(seed=seed)
    states = []
    try:
        for instant in instants:
            wait(world.clock, instant)
            states.append(_state_of(world, "hung", seed, f"hanging for {instant} s"))
    finally:
        world.close()
    return states


def _state_of(world: BulletWorld, kind: str, seed: int, source: str) -> RoomState:
    """What there is in a world now."""
    frame = world.truth_frame()
    return RoomState(
        kind=kind,
        seed=seed,
        gown=world.scene.gown.name,
        person=world.scene.person.name,
        vertices=frame.vertices.astype(np.float32),
        arms=frame.arms.astype(np.float32),
        capsules=frame.robot_capsules.astype(np.float32),
        source=source,
    )


def recorded(folder: Path, frames: int = FRAMES) -> list[RoomState]:
    """States of a recorded run, evenly spread over its time.

    Raises:
        CaretreeError: the folder holds no record of a dressing run whose room can be drawn again.
    """
    try:
        run = json.loads((folder / "run.json").read_text(encoding="utf-8"))
        with np.load(folder / "truth.npz") as truth:
            taken = {name: truth[name] for name in ("vertices", "arms", "robot_capsules", "t", "gripper_closed")}
            loops = {side: truth[f"loop_armhole_{side}"] for side in ("left", "right")}
    except (OSError, ValueError, KeyError) as error:
        raise CaretreeError(f"{folder}: there is no record of a dressing run in it") from error
    given = run.get("parameters", {})
    scene = draw_scene(int(run["seed"]), given.get("gown"), given.get("person"))
    if len(scene.mesh.vertices) != taken["vertices"].shape[1]:
        raise CaretreeError(f"{folder}: its gown is not the one that its seed draws")
    chosen = np.unique(np.linspace(0, len(taken["t"]) - 1, frames).astype(int))
    postures = _postures(folder, taken["t"][chosen])
    vertices, arms = taken["vertices"][chosen], taken["arms"][chosen]
    worn = np.zeros(len(chosen), bool)
    for n, side in enumerate(("left", "right")):
        worn |= crossing(vertices[:, loops[side]].astype(float), arm_line(arms[:, n].astype(float))).net != 0
    states = []
    for k, index in enumerate(chosen):
        low = vertices[k, :, 2].mean() < BED_TOP + LIES_LOW
        hung = (
            vertices[k, :, 2].max() > RAIL_HEIGHT - HUNG_HIGH
            and np.hypot(*(vertices[k, vertices[k, :, 2].argmax(), :2] - scene.rail_xy)) < 0.1
        )
        states.append(
            RoomState(
                kind="worn" if worn[k] else "hung" if hung else "laid" if low else "held",
                seed=int(run["seed"]),
                gown=scene.gown.name,
                person=scene.person.name,
                vertices=vertices[k],
                arms=arms[k],
                capsules=taken["robot_capsules"][index],
                source=f"recorded {run.get('trace_hash', '')[:8]} at {taken['t'][index]:.1f} s",
                posture=postures[k],
            )
        )
    return states


def _postures(folder: Path, t: np.ndarray) -> np.ndarray:
    """(k, 6 + 2 n) how the robot of a record stood at each time (k,), as its joints were read [m, rad].

    Raises:
        CaretreeError: the record does not say.
    """
    try:
        with np.load(folder / "measured.npz") as read:
            names = ("pose_base", "arm_positions", "head_pan", "gripper_opening", "t")
            base, arms, pan, opening, at = (read[name] for name in names)
    except (OSError, ValueError, KeyError) as error:
        raise CaretreeError(f"{folder}: its measured.npz does not say how the robot stood") from error
    n = np.searchsorted(at, t).clip(0, len(at) - 1)
    return np.concatenate((base[n], arms[n].reshape(len(n), -1), pan[n, None], opening[n]), axis=1)


def _bytes(states: Sequence[RoomState]) -> bytes:
    arrays: dict[str, Any] = {}
    for k, state in enumerate(states):
        arrays |= {f"{k}_vertices": state.vertices, f"{k}_arms": state.arms, f"{k}_capsules": state.capsules}
        if state.posture is not None:
            arrays[f"{k}_posture"] = state.posture
    about = [[s.kind, s.seed, s.gown, s.person, s.source] for s in states]
    buffer = io.BytesIO()
    np.savez_compressed(buffer, about=np.array(json.dumps(about)), **arrays)
    return buffer.getvalue()


def read_states(folder: str | Path) -> tuple[list[RoomState], str]:
    """All states in a folder, in the order of their files' names, and a hash of them.

    Raises:
        CaretreeError: there are none.
    """
    states, digest = [], hashlib.sha256()
    for path in sorted(Path(folder).glob("state_*.npz")):
        data = path.read_bytes()
        digest.update(data)
        with np.load(io.BytesIO(data)) as file:
            for k, (kind, seed, gown, person, source) in enumerate(json.loads(str(file["about"]))):
                states.append(
                    RoomState(
                        kind=kind,
                        seed=seed,
                        gown=gown,
                        person=person,
                        source=source,
                        vertices=file[f"{k}_vertices"],
                        arms=file[f"{k}_arms"],
                        capsules=file[f"{k}_capsules"],
                        posture=file.get(f"{k}_posture"),
                    )
                )
    if not states:
        raise CaretreeError(f"{folder}: there are no states; `caretree learn vision states {folder}` makes them")
    return states, digest.hexdigest()[:16]


def make_states(
    folder: str | Path,
    seeds: Iterable[int],
    runs: Sequence[Path] = (),
    gowns: Sequence[str] = (),
    say: Callable[[str], None] = lambda text: None,
    *,
    kinds: Sequence[str] = KINDS,
    frames: int = FRAMES,
    hang: bool = False,
) -> Path:
    """Make what is missing of a folder of states; a file that is there is kept.

    Args:
        folder: made when it is not there.
        seeds: of rooms; every one is prepared hung and in hands, every second one laid and every third one worn,
            as the sleeves slip and as they sit.
        runs: folders of recorded runs.
        gowns: cuts of which each is prepared in every state, with the first seeds for tests.
        say: takes lines of progress.
        kinds: of `KINDS`, those to be prepared.
        frames: taken from each recorded run.
        hang: whether gowns on their hooks are also looked at as they come to hang; in rooms for tests they are not.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    jobs: list[tuple[str, Callable[[], list[RoomState]]]] = []
    seeds = list(seeds)
    wanted = {state: every for state, (kind, every) in PREPARED.items() if kind in kinds}
    for k, seed in enumerate(seeds):
        for state, every in wanted.items():
            test = seed % TEST_SEEDS == TEST_SEEDS - 1
            if k % every == 0 or test:
                jobs.append((f"{seed:04d}_{state}", lambda s=seed, at=state: [prepared(s, at)]))
    for seed in (s for s in seeds if hang and s % TEST_SEEDS != TEST_SEEDS - 1):
        jobs.append((f"{seed:04d}_hanging", lambda s=seed: hanging(s)))
    for gown, seed in ((g, s) for g in gowns for s in seeds if s % TEST_SEEDS == TEST_SEEDS - 1):
        for state in wanted:
            name = f"{seed:04d}_{gown}_{state}"
            jobs.append((name, lambda s=seed, at=state, g=gown: [prepared(s, at, g)]))
    for run in runs:
        name = f"run_{hashlib.sha256((run / 'run.json').read_bytes()).hexdigest()[:8]}"
        jobs.append((name, lambda at=run: recorded(at, frames)))
    for k, (name, make) in enumerate(jobs):
        path = folder / f"state_{name}.npz"
        if not path.exists():
            part = path.with_suffix(".part")
            part.write_bytes(_bytes(make()))
            os.replace(part, path)
            say(f"states: {k + 1} of {len(jobs)}, {name}")
    return folder
