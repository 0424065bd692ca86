"""The packaged network, run by OpenCV alone, and how its maps are read."""

import re
import subprocess
import sys

import numpy as np
import pytest
from caretree.learning.vision.dataset import seen
from caretree.learning.vision.labels import KEY_POINTS, SURFACES
from caretree.learning.vision.sheet_nodes import SHEET_NODES
from caretree.perception.image.surfaces import Surface
from caretree.perception.learned.sight import FORMAT, PACKAGED, PACKAGED_HAND, SeeingNetwork
from caretree.sim.errors import CaretreeError
from caretree.sim.world import Frame


def frame(size=(300, 400), depth=1.5):
    rng = np.random.default_rng(0)
    pose = np.eye(4)
    pose[:3, :3] = np.array(((1, 0, 0), (0, -1, 0), (0, 0, -1)))  # straight down
    pose[2, 3] = 2.0
    return Frame(
        camera="head",
        stamp=3.0,
        rgb=rng.integers(0, 255, (*size, 3), dtype=np.uint8),
        depth=np.full(size, depth, np.float32),
        intrinsics=(200.0, 200.0, (size[1] - 1) / 2, (size[0] - 1) / 2),
        pose_camera_in_map=pose,
    )


class Planted:
    """Stands for OpenCV's network: maps with one key point and one surface."""

    def __init__(self, **maps):
        self.maps = maps

    def setInput(self, image):  # noqa: N802 - OpenCV's name
        self.image = image

    def forward(self, names):
        return [self.maps[name] for name in names]


@pytest.fixture
def network():
    return SeeingNetwork()


@pytest.fixture
def planted(network):
    surface = np.zeros((1, 7, 192, 256), np.float32)
    surface[:, Surface.OUTSIDE] = 4.0
    heat = np.full((1, 17, 48, 64), -9.0, np.float32)
    heat[0, KEY_POINTS.index("corner_left"), 24, 40] = 5.0
    offset = np.full((1, 17, 48, 64), 0.1, np.float32)
    network._net = Planted(surface=surface, sheet=np.zeros((1, 35, 48, 64), np.float32), heat=heat, offset=offset)
    return network


@pytest.mark.parametrize("path", [PACKAGED, PACKAGED_HAND])
def test_a_packaged_network_says_how_it_was_trained(path):
    record = SeeingNetwork(path).record
    assert {"data", "seed", "steps", "processor_seconds", "machine", "made"} <= set(record)


def test_all_that_is_learned_of_seeing_and_grasping_is_at_most_8_mb():
    assert sum(path.stat().st_size for path in PACKAGED.parent.glob("*.onnx")) < 8e6


def test_what_it_sees_has_the_frame_s_size(network):
    sight = network.see(frame((240, 320)))
    assert sight.surfaces.shape == sight.confidence.shape == (240, 320)
    assert sight.sheet.shape == (240, 320, 3)
    assert set(sight.key_points) == set(KEY_POINTS)
    assert all(0 <= point.confidence <= 1 for point in sight.key_points.values())


def test_it_is_given_what_it_was_trained_on(network):
    shot, bed = frame(), np.array(((-0.3, -0.5, 0.0), (0.3, 0.5, 0.5)))
    for knows, told in ((True, bed), (True, None), (False, bed)):
        network._knows_bed = knows
        wanted = seen(shot.rgb, shot.depth, shot.pose_camera_in_map, shot.intrinsics, told)
        assert np.array_equal(network.image_of(shot, told), wanted if knows else wanted[:5])


def test_a_peak_becomes_a_place_in_the_map(planted):
    point = planted.see(frame()).key_points["corner_left"]
    u, v = (40 + 0.5) * 4 * 400 / 256 - 0.5, (24 + 0.5) * 4 * 300 / 192 - 0.5
    assert np.allclose(point.pixel, (u, v), atol=0.5)
    deep = 1.5 + 0.1
    wanted = ((u - 199.5) / 200 * deep, -(v - 149.5) / 200 * deep, 2.0 - deep)
    assert np.allclose(point.position_in_map, wanted, atol=0.01)
    assert point.confidence > planted.see(frame()).key_points["corner_right"].confidence


def test_a_place_on_the_sheet_is_the_mean_of_the_best_node_and_its_neighbours(planted):
    scores = planted._net.maps["sheet"]
    first, wanted = 0, []
    for axis in SHEET_NODES:
        best = len(axis) // 2
        scores[0, first + best], scores[0, first + best + 1] = 9.0, 9.0
        wanted.append((axis[best] + axis[best + 1]) / 2)
        first += len(axis)
    assert np.allclose(planted.see(frame()).sheet, wanted, atol=1e-3)


def test_another_format_is_refused_in_one_sentence(tmp_path):
    changed = re.sub(FORMAT[:-1].encode() + b"[0-9]", FORMAT[:-1].encode() + b"1", PACKAGED.read_bytes())
    other = tmp_path / "seeing.onnx"
    other.write_bytes(changed)
    with pytest.raises(CaretreeError, match=f"no seeing network in format {FORMAT}"):
        SeeingNetwork(other)


def test_confidence_is_what_the_calibration_was_fitted_to(planted):
    planted._calibration = {"corner": [0.7, -0.4]}
    heat = planted._net.maps["heat"][0, KEY_POINTS.index("corner_left")]
    heat[24, 41], heat[3, 3] = 4.0, 3.5
    here = np.exp(5.0) + np.exp(4.0) + 7 * np.exp(-9.0)
    elsewhere = np.exp(3.5) + (48 * 64 - 10) * np.exp(-9.0) + 1.0  # the one is nowhere
    wanted = 1 / (1 + np.exp(-(0.7 * np.log(here / elsewhere) - 0.4)))
    assert abs(planted.see(frame()).key_points["corner_left"].confidence - wanted) < 1e-6


def test_without_depth_a_key_point_has_no_place(planted):
    assert planted.see(frame(depth=0.0)).key_points["corner_left"].position_in_map is None


def test_the_surfaces_are_those_of_the_training():
    assert [surface.name.lower() for surface in Surface] == list(SURFACES)


def test_a_missing_network_is_told_in_one_sentence(tmp_path):
    with pytest.raises(CaretreeError, match="no network in an ONNX file"):
        SeeingNetwork(tmp_path / "none.onnx")


def test_nothing_heavy_is_imported_to_see():
    code = (
        "import sys; from caretree.perception.learned.sight import packaged_network; packaged_network(); "
        "sys.exit(any(name in sys.modules for name in ('torch', 'onnx', 'caretree.learning')))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
