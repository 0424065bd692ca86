"""A made-up record of a dressed person, written through the real recorder, for every test that reads records."""

from __future__ import annotations

import signal
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from caretree.sim.record.record import RunResult, StageResult
from caretree.sim.record.recorder import FRAME_PERIOD, Recorder
from caretree.sim.record.truth import TruthFrame, TruthStatic

ARM_X = 0.28  # [m] both arms lie straight along y beside the torso, so a sleeve slides on without touching
MOVE, HOLD = 60, 32  # frames of the way from the rail and of the worn gown held still


def tube(x: float, ys: np.ndarray, radius: float = 0.09, count: int = 12) -> np.ndarray:
    """(len(ys) * count, 3) rings around an arm along +y, ordered right-handed about +y [m]."""
    angle = -2 * np.pi * np.arange(count) / count
    return np.concatenate(
        [np.stack([x + radius * np.cos(angle), np.full(count, y), radius * np.sin(angle)], axis=1) for y in ys]
    )


def quads(rows: int, columns: int, start: int, wrap: bool) -> np.ndarray:
    """(F, 3) triangles of a grid of vertices numbered row by row from `start`."""
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns if wrap else columns - 1), indexing="ij")
    a, b = i * columns + j, i * columns + (j + 1) % columns
    faces = np.stack([np.stack([a, b, a + columns], -1), np.stack([b, b + columns, a + columns], -1)]).reshape(-1, 3)
    return faces + start


def gown() -> TruthStatic:
    """A sheet over the torso and a tube around each arm, in its worn place, which is also its rest shape."""
    x, y = np.meshgrid(np.linspace(-0.25, 0.25, 11), np.linspace(-0.05, 0.65, 15))
    sheet = np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.03)], axis=1)
    ys = np.linspace(0.05, 0.25, 5)
    right, left = tube(ARM_X, ys), tube(-ARM_X, ys)
    first_right, first_left = len(sheet), len(sheet) + len(right)
    loops = {}
    for side, first in (("right", first_right), ("left", first_left)):
        loops[f"armhole_{side}"], loops[f"cuff_{side}"] = first + np.arange(12), first + 48 + np.arange(12)
    return TruthStatic(
        faces=np.concatenate(
            [quads(15, 11, 0, wrap=False), quads(5, 12, first_right, wrap=True), quads(5, 12, first_left, wrap=True)]
        ),
        rest_vertices=np.concatenate([sheet, right, left]),
        loops=loops,
        arm_radii=np.tile([0.05, 0.045, 0.04], (2, 1)),
        person_parts=("torso", "left_arm", "right_arm"),
        robot_capsule_names=("left_palm", "right_palm"),
        person_capsules=np.array([(0.0, -0.1, 0.0, 0.0, -0.25, 0.0, 0.08), (0.0, 0.1, -0.1, 0.0, 0.5, -0.1, 0.1)]),
        person_capsule_names=("neck_head", "trunk"),
        bed_top=-0.1,
        face=np.array((0.0, -0.2, 0.08, 0.0, 0.0, 1.0)),
        neckline=np.arange(11),
    )


def frame(static: TruthStatic, index: int) -> TruthFrame:
    """The gown slides 2 m along the arms, then stays."""
    left = max(0.0, 1.0 - index / MOVE)
    arms = np.array([[[x, y, 0.0] for y in (0.0, 0.3, 0.55, 0.72)] for x in (-ARM_X, ARM_X)])
    # beside the sheet's own lines, on which one layer counts for the triangles on either side
    x, y = np.meshgrid(np.linspace(-0.143, 0.157, 10), np.linspace(0.012, 0.562, 12))
    torso = np.stack([x.ravel(), y.ravel(), np.zeros(x.size), *np.zeros((2, x.size)), np.ones(x.size)], axis=1)
    held = index < MOVE + 3
    pose = np.array([[x, 0.1 + 2 * left, 0.15, 0, 0, 0, 1] for x in (-0.2, 0.2)])
    load = np.array([[0, 3.0 + np.sin(index / 5), 1.0]] * 2) * held
    return TruthFrame(
        t=index * FRAME_PERIOD,
        vertices=static.rest_vertices + np.array([0, 2 * left, 0]),
        arms=arms,
        torso_front=torso,
        gripper_pose=pose,
        gripper_closed=np.full(2, held),
        gripper_load=load,
        person_force=np.array([0.5, 2.0 * held, 1.0]),
        robot_capsules=np.array([(x, -0.5, 1.0, x, -0.6, 1.0, 0.05) for x in (-0.5, 0.5)]),
        holds_arm=np.full(2, -1),
    )


RESULT = RunResult(
    outcome="success",
    reason="The person is dressed.",
    sim_time_s=(MOVE + HOLD - 1) * FRAME_PERIOD,
    stages=tuple(
        StageResult(
            name=name,
            status="success",
            attempts=k,
            t_start=2.0 * i,
            t_end=2.0 * i + 1.9,
            reason="sleeve caught on the hand" if k > 1 else "",
        )
        for i, (name, k) in enumerate([("A grasp", 1), ("B unfold", 1), ("C dress", 2), ("D spread", 1)])
    ),
    timing={"physics": 3.0, "camera": 1.0, "perception": 0.5},
)


@pytest.fixture
def make_record() -> Callable[..., Path]:
    """Write a whole record into a folder: `make_record(folder, seed=3, pictures=True)`; one cut short if no result."""

    def make(directory: Path, *, seed: int = 0, pictures: bool = False, result: RunResult | None = RESULT) -> Path:
        recorder = Recorder(directory, task="dressing", seed=seed, world="bullet", parameters={"gown": "small"})
        static = gown()
        recorder.begin(static)
        for index in range(MOVE + HOLD):
            recorder.frame(frame(static, index))
            if index % 10 == 0:
                stage = "ABCD"[min(3, index // 25)]
                pulled = "FAILURE" if index == 40 else "SUCCESS"
                for leaf, status, offset in (
                    ("look", "RUNNING", 0.0),
                    ("look", "SUCCESS", 0.2),
                    ("pull", "RUNNING", 0.2),
                    ("pull", pulled, 0.7),
                ):
                    recorder.event(
                        {
                            "t": round(index * FRAME_PERIOD + offset, 6),
                            "kind": "node",
                            "node": f"dressing/{stage}/{leaf}",
                            "status": status,
                        }
                    )
            if pictures and index % 2 == 0:
                image = np.full((48, 64, 3), 2 * index, dtype=np.uint8)
                recorder.picture(index * FRAME_PERIOD, image)
        if result is None:
            recorder.close()
        else:
            recorder.finish(result)
        return directory

    return make


def pytest_collection_modifyitems(items: list[pytest.Item]):
    """Files with tests that take minutes come first, so that in the end no worker waits for another one's long test."""
    long = {item.path for item in items if item.get_closest_marker("no_cover")}
    items.sort(key=lambda item: item.path not in long)


@pytest.fixture(autouse=True, scope="session")
def signals_of_a_terminal():
    """In the background of a script, or under nohup, SIGINT or SIGHUP are ignored, by the product too.

    A run that waits for one of them would never end.
    """
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
