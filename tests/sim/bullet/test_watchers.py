"""Frames come when they are due, to everybody, whoever fails."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from caretree.sim.bullet.watchers import PICTURE_PERIOD, Watchers
from caretree.sim.record.recorder import FRAME_PERIOD
from caretree.sim.render.camera import Renderer
from caretree.sim.render.film import FILM_SIZE
from caretree.sim.render.raster import Light

TRUTH = SimpleNamespace(gripper_pose=np.array([(0.0, y, 1.0, 0, 0, 0, 1) for y in (-0.2, 0.2)]))


@pytest.fixture
def watchers():
    room = Renderer(Light(direction_in_map=np.array((0.0, 0.0, 1.0))))
    diorama = SimpleNamespace(renderer=room, shell=(), follow=lambda seen: seen)
    return Watchers(lambda: TRUTH, lambda: room, diorama, {})


def recorder(**options):
    quiet = {"begin": lambda static: None, "frame": lambda truth: None, "film": lambda t, draw: None}
    return SimpleNamespace(**{"caption": ("dress", "pull"), "films": True, **quiet, **options})


def test_frames_and_pictures_come_in_their_periods(watchers):
    began, frames, pictures = [], [], []
    film = lambda t, draw: pictures.append((t, draw))  # noqa: E731
    watchers.record(recorder(begin=began.append, frame=frames.append, film=film), "static", lambda error: None)
    assert began == ["static"]
    for time in np.arange(0.0, 1.0, 0.0025):
        if watchers.due(time):
            watchers.look(time)
    assert len(frames) == len(np.arange(0.0, 1.0, FRAME_PERIOD))
    assert np.diff([t for t, _ in pictures]) == pytest.approx(PICTURE_PERIOD)
    assert pictures[0][1]().shape[:2] == FILM_SIZE[::-1]


def test_nothing_is_drawn_for_a_record_without_a_video(watchers):
    pictures, frames = [], []
    film = lambda t, draw: pictures.append(t)  # noqa: E731
    watchers.record(recorder(frame=frames.append, film=film, films=False), "static", lambda error: None)
    watchers.look(0.0)
    assert (len(frames), pictures) == (1, [])


def test_a_view_that_fails_is_told_once_and_the_recorder_goes_on(watchers):
    def show(time, room):
        assert isinstance(room, Renderer)
        raise OSError("nobody listens")

    told, frames = [], []
    watchers.show(SimpleNamespace(show=show))
    watchers.record(recorder(frame=frames.append), "static", told.append)
    for n in range(5):
        watchers.look(n * FRAME_PERIOD)
    assert [str(error) for error in told] == ["nobody listens"]
    assert len(frames) == 5
