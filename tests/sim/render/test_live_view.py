"""The live view answers a browser with what the simulation draws."""

from __future__ import annotations

import threading
import urllib.error
import urllib.request

import numpy as np
import pytest
from caretree.sim.errors import DisplayError
from caretree.sim.render.live_view import TARGET, LiveView, orbit


@pytest.fixture
def view():
    """A server that draws grey pictures."""
    view = LiveView()
    stop = threading.Event()
    poses: list[np.ndarray] = []

    def draw(pose: np.ndarray) -> np.ndarray:
        poses.append(pose)
        return np.full((48, 64, 3), 90, np.uint8)

    def simulate() -> None:
        while not stop.is_set():
            view.serve(draw)
            stop.wait(0.01)

    thread = threading.Thread(target=simulate)
    thread.start()
    yield view, poses
    stop.set()
    thread.join()
    view.close()


def test_the_page_and_a_frame(view):
    server, poses = view
    with urllib.request.urlopen(server.url) as page:
        assert b"/frame" in page.read()
    with urllib.request.urlopen(server.url + "frame?a=30&e=40&d=2") as frame:
        assert frame.read()[:2] == b"\xff\xd8"  # a JPEG
    np.testing.assert_allclose(poses[-1], orbit(30, 40, 2))


def test_a_picture_that_cannot_be_drawn_is_an_error_of_the_display():
    def draw(pose: np.ndarray) -> np.ndarray:
        raise ZeroDivisionError("planted")

    view = LiveView()
    view.serve(draw)  # nobody asks
    view._asked = (0.0, 30.0, 2.0)
    with pytest.raises(DisplayError, match="the live view cannot be drawn: planted"):
        view.serve(draw)
    view.close()


def test_nonsense_is_no_frame(view):
    server, _ = view
    with pytest.raises(urllib.error.HTTPError, match="503"), urllib.request.urlopen(server.url + "frame?a=x"):
        pass


def test_the_camera_turns_about_the_target():
    for azimuth in (0, 90, 200):
        pose = orbit(azimuth, 30, 2.5)
        to_target = TARGET - pose[:3, 3]
        assert np.linalg.norm(to_target) == pytest.approx(2.5)
        np.testing.assert_allclose(pose[:3, 2], to_target / 2.5, atol=1e-9)
