"""The project's evaluator and the outside judge say the same of good and of damaged records."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.evaluate.coverage import coverage
from caretree.sim.evaluate.crossings import crossing
from caretree.sim.evaluate.plausibility import depth_inside
from caretree.sim.evaluate.verdict import evaluate

Arrays = dict[str, np.ndarray]


def judged(judge, directory: Path) -> int:
    """Exit class of the judge: 0 dressed, 1 not, 2 unreadable (a crash counts as unreadable)."""
    try:
        return 0 if judge.judge(directory)["dressed"] else 1
    except Exception:
        return 2


def evaluated(directory: Path) -> int:
    try:
        return 0 if evaluate(directory).dressed else 1
    except RecordError:
        return 2


def shift_sleeve(z: Arrays, side: str, offset: tuple[float, float, float]) -> None:
    """Move the 60 vertices of one sleeve in the last ten frames."""
    first = int(z[f"loop_armhole_{side}"].min())
    z["vertices"][-10:, first : first + 60] += np.array(offset, dtype=np.float32)


def sleeve_off(z: Arrays) -> None:
    shift_sleeve(z, "left", (0.0, 0.0, 0.4))


def sleeve_snaps_back(z: Arrays) -> None:
    """On at the end, but off two frames within the last two seconds."""
    first = int(z["loop_armhole_left"].min())
    z["vertices"][-12:-10, first : first + 60] += np.float32([0.0, 0.3, 0.0])


def wrong_way_in(z: Arrays) -> None:
    """Armhole and cuff swapped: the arm comes in at the cuff."""
    z["loop_armhole_right"], z["loop_cuff_right"] = z["loop_cuff_right"], z["loop_armhole_right"]


def reversed_loop(z: Arrays) -> None:
    z["loop_cuff_left"] = z["loop_cuff_left"][::-1].copy()


def armhole_short(z: Arrays) -> None:
    """Every frame later on the arm by a third of it: armhole at 0.5 of the upper arm."""
    z["arms"][..., 1] -= 0.1


def uncovered(z: Arrays) -> None:
    z["torso_front"][:, ::2, 0] += 1.0


def inside_out(z: Arrays) -> None:
    z["faces"] = z["faces"][:, ::-1].copy()


def still_gripped(z: Arrays) -> None:
    z["gripper_closed"][-1, 1] = True


def gripped_long_ago(z: Arrays) -> None:
    z["gripper_closed"][-30:-28, 0] = True


def nan_vertex(z: Arrays) -> None:
    z["vertices"][40, 17, 2] = np.nan


def nan_arm_at_end(z: Arrays) -> None:
    z["arms"][-1, 0, 1, 0] = np.nan


def teleport(z: Arrays) -> None:
    z["vertices"][30:, :, 1] -= 0.7


def overstretched(z: Arrays) -> None:
    z["vertices"][20:24, :12, 2] += np.float32(0.06) * (np.arange(12) % 2).astype(np.float32)


def one_long_edge(z: Arrays) -> None:
    z["vertices"][20:, 0, 2] += 0.1


def penetrates(z: Arrays) -> None:
    z["arm_radii"] = z["arm_radii"] + np.float32(0.055)


def frame_gap(z: Arrays) -> None:
    z["t"][50:] += 0.05


def heavy_load(z: Arrays) -> None:
    z["gripper_load"][30, 1] = [0.0, 0.0, 30.0]


def load_on_open_gripper(z: Arrays) -> None:
    z["gripper_load"][-5, 1] = [0.0, 0.0, 30.0]


def dressed_at_once(z: Arrays) -> None:
    z["vertices"][:] = z["vertices"][-1]


def never_moved(z: Arrays) -> None:
    z["vertices"][:] = z["vertices"][0]


def time_runs_back(z: Arrays) -> None:
    z["t"][40] = z["t"][38]


def missing_array(z: Arrays) -> None:
    del z["loop_cuff_left"]


def three_points_per_arm(z: Arrays) -> None:
    z["arms"] = z["arms"][:, :, :3]


def too_few_frames_of_vertices(z: Arrays) -> None:
    z["vertices"] = z["vertices"][:-3]


def one_frame(z: Arrays) -> None:
    for name in ("t", "vertices", "arms", "torso_front", "gripper_closed", "gripper_load"):
        z[name] = z[name][:1]


def no_frames(z: Arrays) -> None:
    for name in ("t", "vertices", "arms", "torso_front", "gripper_closed", "gripper_load"):
        z[name] = z[name][:0]


def face_out_of_range(z: Arrays) -> None:
    z["faces"][3, 1] = 10_000


def faces_of_floats(z: Arrays) -> None:
    z["faces"] = z["faces"].astype(np.float64)


def nothing(z: Arrays) -> None:
    """The good record."""


DAMAGE: list[tuple[Callable[[Arrays], None], int]] = [
    (nothing, 0),
    (load_on_open_gripper, 0),
    (gripped_long_ago, 0),
    (sleeve_off, 1),
    (sleeve_snaps_back, 1),
    (wrong_way_in, 1),
    (reversed_loop, 1),
    (armhole_short, 1),
    (uncovered, 1),
    (inside_out, 1),
    (still_gripped, 1),
    (nan_vertex, 1),
    (nan_arm_at_end, 1),
    (teleport, 1),
    (overstretched, 1),
    (one_long_edge, 1),
    (penetrates, 1),
    (frame_gap, 1),
    (heavy_load, 1),
    (dressed_at_once, 1),
    (never_moved, 1),
    (time_runs_back, 1),
    (missing_array, 2),
    (three_points_per_arm, 2),
    (too_few_frames_of_vertices, 2),
    (one_frame, 2),
    (no_frames, 2),
    (face_out_of_range, 2),
    (faces_of_floats, 2),
]


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # the judge computes on NaN
@pytest.mark.parametrize(("damage", "expected"), DAMAGE, ids=[damage.__name__ for damage, _ in DAMAGE])
def test_same_verdict(damaged_record, outside_judge, damage, expected):
    directory = damaged_record(damage)
    assert evaluated(directory) == expected
    if outside_judge is not None:
        assert judged(outside_judge, directory) == expected


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # the judge leaves its file open
@pytest.mark.parametrize("keep", [0, 1, 100, 20_000])
def test_truncated_truth_is_unreadable_to_both(make_record, tmp_path, outside_judge, keep):
    directory = make_record(tmp_path / "run")
    path = directory / "truth.npz"
    path.write_bytes(path.read_bytes()[:keep])
    assert evaluated(directory) == 2
    if outside_judge is not None:
        assert judged(outside_judge, directory) == 2


@pytest.mark.parametrize("text", ["", "{", None])
def test_damaged_run_json_is_unreadable_to_both(make_record, tmp_path, outside_judge, text):
    directory = make_record(tmp_path / "run")
    (directory / "run.json").unlink()
    if text is not None:
        (directory / "run.json").write_text(text)
    assert evaluated(directory) == 2
    if outside_judge is not None:
        assert judged(outside_judge, directory) == 2


def test_same_numbers(make_record, tmp_path, judge):
    directory = make_record(tmp_path / "run")
    ours, theirs = evaluate(directory).numbers, judge.judge(directory)
    for name, value in {
        "upper_arm_left": theirs["upper_arm_ratio"]["left"],
        "upper_arm_right": theirs["upper_arm_ratio"]["right"],
        "coverage": theirs["coverage"],
        "outside_out": theirs["outside_out"],
        "stretch_p99": theirs["stretch_p99"],
        "stretch_max": theirs["stretch_max"],
        "arm_depth_max_m": theirs["arm_depth_max_m"],
    }.items():
        assert ours[name] == pytest.approx(value, abs=6e-4), name
    assert ours["vertex_speed_max_m_per_s"] == pytest.approx(theirs["vertex_speed_max"], abs=6e-3)
    assert ours["gripper_load_max_n"] == pytest.approx(theirs["gripper_load_max_n"], abs=6e-3)


def test_same_exit_status_as_the_judges_command(make_record, tmp_path, judge):
    directory = make_record(tmp_path / "run")
    done = subprocess.run([sys.executable, judge.__file__, str(directory)], check=False, capture_output=True, text=True)
    assert done.returncode == evaluated(directory) == 0, done.stdout


def test_random_loops_are_crossed_alike(judge):
    rng = np.random.default_rng(3)
    nets = []
    for _ in range(300):
        loop = rng.normal(size=(int(rng.integers(3, 16)), 3))
        line = np.cumsum(rng.normal(size=(6, 3)), axis=0) - 1.0
        ours = crossing(loop[None], line[None])
        net, at = judge.net_crossing(loop, line)
        nets.append(net)
        assert ours.net[0] == net
        if net:
            assert ours.at[0] == pytest.approx(at, abs=5e-3)  # the judge moves the fan's centre by 0.1 mm
    assert {-1, 0, 1} <= set(nets)


def test_random_cloth_covers_alike(judge):
    rng = np.random.default_rng(4)
    for scale in (0.02, 0.1, 0.3):
        x, y = np.meshgrid(np.linspace(-0.3, 0.3, 13), np.linspace(-0.3, 0.3, 13))
        vertices = np.stack([x.ravel(), y.ravel(), rng.normal(0.05, scale, x.size)], axis=1)
        cells = np.array([[r * 13 + c, r * 13 + c + 1, r * 13 + c + 13] for r in range(12) for c in range(12)])
        points, normals = rng.uniform(-0.4, 0.4, (150, 3)) * [1, 1, 0.1], rng.normal([0, 0, 3], 1.0, (150, 3))
        torso = np.hstack([points, normals / np.linalg.norm(normals, axis=1, keepdims=True)])
        assert coverage(vertices, cells, torso) == pytest.approx(judge.coverage(vertices, cells, torso))


def test_random_arms_are_penetrated_alike(judge):
    rng = np.random.default_rng(5)
    for _ in range(20):
        vertices, arm = rng.normal(size=(200, 3)), rng.normal(size=(4, 3))
        radii = rng.uniform(0.02, 0.3, 3)
        ours = max(depth_inside(vertices[None], arm[None, k], arm[None, k + 1], radii[k])[0] for k in range(3))
        assert ours == pytest.approx(judge.depth_inside(vertices, arm, radii))
