"""Images are read as they are encoded."""

from types import SimpleNamespace

import numpy as np
import pytest
from caretree.sim.ros1 import cameras as module
from caretree.sim.ros1.cameras import LATE, Cameras, metres, pixels
from caretree.sim.ros1.senses import Sample
from caretree.sim.world import SensorLost


def image(array, encoding, *, padding=0, big=0):
    rows = np.ascontiguousarray(array).view(np.uint8).reshape(array.shape[0], -1)
    rows = np.pad(rows, ((0, 0), (0, padding)))
    return SimpleNamespace(
        height=array.shape[0],
        width=array.shape[1],
        step=rows.shape[1],
        encoding=encoding,
        is_bigendian=big,
        data=rows.tobytes(),
    )


def test_colours_come_as_red_green_blue():
    colours = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3)
    assert np.array_equal(pixels(image(colours, "rgb8", padding=5)), colours)
    assert np.array_equal(pixels(image(colours, "bgr8")), colours[:, :, ::-1])
    with pytest.raises(SensorLost, match="a colour image comes as yuv422, but rgb8 or bgr8 is asked for"):
        pixels(image(colours, "yuv422"))


def test_depths_come_in_metres_and_none_is_zero():
    millimetres = np.array(((0, 1500), (65535, 20)), np.uint16)
    assert np.allclose(metres(image(millimetres, "16UC1", padding=2)), millimetres / 1000.0)
    assert np.allclose(metres(image(millimetres.astype(">u2"), "16UC1", big=1)), millimetres / 1000.0)
    depths = np.array(((np.nan, 1.5), (np.inf, -1.0)), np.float32)
    assert np.array_equal(metres(image(depths, "32FC1")), np.array(((0.0, 1.5), (0.0, 0.0)), np.float32))
    with pytest.raises(SensorLost, match="a depth image comes as 8UC1"):
        metres(image(millimetres, "8UC1"))


class Wall:
    """Time passes while somebody sleeps; a frame comes meanwhile."""

    def __init__(self, eye, *frames):
        self.time, self.eye, self.frames = 0.0, eye, list(frames)

    def monotonic(self):
        return self.time

    def sleep(self, time):
        self.time += time
        if self.frames:
            self.eye.frame = self.frames.pop(0)


@pytest.fixture
def eye():
    return SimpleNamespace(frame=Sample(1.0, None))


@pytest.fixture
def looking(eye):
    cameras = Cameras.__new__(Cameras)
    cameras._eyes = {"head": eye}
    return cameras


def test_where_time_waits_it_waits_for_an_image(looking, eye, monkeypatch):
    monkeypatch.setattr(module, "wall", wall := Wall(eye, Sample(1.2, None), Sample(1.4, None), Sample(1.6, None)))
    looking.wait("head", 1.3)
    assert eye.frame.stamp == 1.4
    looking.wait("head", 1.4)
    assert len(wall.frames) == 1, "what is there is not waited for"


def test_a_camera_that_is_dead_is_waited_for_for_a_moment_and_none_at_all_that_there_is_not(looking, eye, monkeypatch):
    monkeypatch.setattr(module, "wall", wall := Wall(eye))
    looking.wait("tail", 1.3)
    assert wall.time == 0.0
    looking.wait("head", 1.3)
    assert wall.time == pytest.approx(LATE, abs=0.01)
    looking.wait("head", -np.inf)
    assert wall.time == pytest.approx(LATE, abs=0.01)
