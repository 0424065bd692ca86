"""Images are read as they are encoded."""

from types import SimpleNamespace

import numpy as np
import pytest
from caretree.sim.ros1.cameras import metres, pixels
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
