"""The gown as one thing: cloth, hook and the effects on it."""

from types import SimpleNamespace

import numpy as np
import pytest
from caretree.sim.bullet import gown as module
from caretree.sim.bullet.gown import Gown
from caretree.sim.scene.scene import RAIL_HEIGHT, draw_scene


class Patch:
    """Effects that only tell what was asked of them."""

    def __init__(self):
        self.release_t, self.calls = 1.0, []

    def apply(self, time):
        self.calls.append(("apply", time))

    def attach(self, client, body, vertices):
        self.calls.append(("attach", body))

    def detach(self):
        self.calls.append(("detach",))


@pytest.fixture
def patch():
    return Patch()


@pytest.fixture
def gown(monkeypatch, patch):
    """One with effects, on a hook that only tells what was asked of it."""
    scene = draw_scene(1)
    cloth = SimpleNamespace(body=5, remove=lambda: setattr(cloth, "body", -1))

    def load(soft, mesh, start, effects, pinned, capsules):
        assert pinned == {scene.hang_vertex}
        np.testing.assert_allclose(start[scene.hang_vertex], (*scene.rail_xy, RAIL_HEIGHT))
        return cloth, patch

    monkeypatch.setattr(module, "load_gown", load)
    monkeypatch.setattr(module, "Hook", lambda *_: SimpleNamespace(release=lambda: patch.calls.append(("release",))))
    gown = Gown(None, None, scene, object(), np.zeros((0, 7)))
    gown.hang_up(None)
    return gown


def test_it_slips_once_out_of_a_hand_when_its_time_has_come(gown, patch):
    slipped = []
    grips = [SimpleNamespace(kind=kind, release=lambda kind=kind: slipped.append(kind)) for kind in ("arm", "cloth")]
    gown.apply_effects(0.5, grips)
    assert not slipped
    gown.apply_effects(1.0, grips[:1])
    assert not slipped, "nobody holds it yet"
    gown.apply_effects(1.5, grips)
    gown.apply_effects(2.0, grips)
    assert slipped == ["cloth"]
    assert patch.calls == [("apply", 0.5), ("apply", 1.0), ("apply", 1.5), ("apply", 2.0)]


def test_effects_are_taken_off_while_it_is_put_elsewhere(gown, patch):
    gown.take_off_hook()
    gown.put_down(None, np.zeros((3, 3)))
    assert patch.calls == [("release",), ("detach",), ("attach", 5)]


def test_what_was_taken_away_has_no_effects_any_more(gown, patch):
    gown.remove()
    assert gown.gone
    patch.calls.clear()
    gown.apply_effects(2.0, [])
    gown.put_down(None, np.zeros((0, 3)))
    assert not patch.calls
