"""Frames come when they are due, to everybody, whoever fails."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from caretree.sim.bullet.backdrop import SPECTATOR, SPECTATOR_SIZE
from caretree.sim.bullet.watchers import PICTURE_PERIOD, Watchers
from caretree.sim.record.recorder import FRAME_PERIOD
from caretree.sim.render.live_view import SIZE


class Renderer:
    """Draws the size that it is asked for."""

    def render(self, pose, size):
        return SimpleNamespace(rgb=np.zeros((size[1], size[0], 3), np.uint8), pose=pose)


@pytest.fixture
def watchers():
    return Watchers(lambda: "truth", Renderer)


def test_frames_and_pictures_come_in_their_periods(watchers):
    frames, pictures, began = [], [], []
    recorder = SimpleNamespace(
        begin=began.append, frame=frames.append, picture=lambda t, image: pictures.append((t, image.shape))
    )
    watchers.record(recorder, "static", lambda error: None)
    assert began == ["static"]
    for time in np.arange(0.0, 1.0, 0.0025):
        if watchers.due(time):
            watchers.look(time)
    assert len(frames) == len(np.arange(0.0, 1.0, FRAME_PERIOD))
    assert np.diff([t for t, _ in pictures]) == pytest.approx(PICTURE_PERIOD)
    assert pictures[0][1][:2] == SPECTATOR_SIZE[::-1]
    assert np.shape(SPECTATOR) == (4, 4)


def test_a_view_that_fails_is_told_once_and_the_recorder_goes_on(watchers):
    def serve(draw):
        assert draw(np.eye(4)).shape[:2] == SIZE[::-1]
        raise OSError("nobody listens")

    told, frames = [], []
    watchers.show(SimpleNamespace(serve=serve))
    recorder = SimpleNamespace(begin=lambda static: None, frame=frames.append, picture=lambda t, image: None)
    watchers.record(recorder, "static", told.append)
    for n in range(5):
        watchers.look(n * FRAME_PERIOD)
    assert [str(error) for error in told] == ["nobody listens"]
    assert len(frames) == 5
