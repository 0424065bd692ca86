"""Compare ways of seeing on the same pictures, none of which any training saw.

Who sees is given from outside: this layer knows neither the network's run-time nor the classical perception.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

import numpy as np

from ...sim.render.looks import LIGHTS, PLAIN, PRINTED, RANDOM, TAPED
from ...sim.world import SIDES, Frame, Side
from .labels import ABSENT, INSIDE, JOINTS, KEY_POINTS, OTHER, OUTSIDE, SHOWN, SKIN
from .pictures import Picture, chosen_states, draw_picture
from .scores import Tally
from .states import KINDS, RoomState

Found = tuple[np.ndarray, float]  # a place (3,) in the map [m] and the confidence in it
SETS = {  # name -> part, look
    "plain": ("test", PLAIN),
    "printed": ("test", PRINTED),
    "random": ("test", RANDOM),
    "held out": ("heldout", RANDOM),
    "taped": ("test", TAPED),
}
NEAR = {"corner": 0.05, "strap": 0.04}  # that counts as found [m]
TOLD = 0.05  # of the place that a way of seeing is told beforehand, standard deviation [m]
KEY_POINT = 0.08  # within which a key point's confidence was right [m]


class Seer(Protocol):
    """A way of seeing single frames; what it cannot see it leaves out."""

    def surfaces(self, frame: Frame) -> np.ndarray:
        """(H, W) index in `labels.SURFACES`."""
        ...

    def confidence(self, frame: Frame) -> np.ndarray | None:
        """(H, W) in the surfaces, 0 to 1."""
        ...

    def sheet(self, frame: Frame) -> np.ndarray | None:
        """(H, W, 3) place on the gown's sheet [m]."""
        ...

    def corner(self, frame: Frame, side: Side, hook_in_map: np.ndarray | None) -> Found | None:
        """One end of the neckline; the hook (3,) is told where the gown hangs on it."""
        ...

    def strap(self, frame: Frame, side: Side, near_in_map: np.ndarray) -> Found | None:
        """The middle of a strap; told is roughly where its armhole is (3,) [m]."""
        ...

    def arm(self, frame: Frame, side: Side) -> tuple[np.ndarray, np.ndarray] | None:
        """Shoulder, elbow, wrist and fingertip (4, 3) [m], and which of them are in view (4,)."""
        ...

    def key_points(self, frame: Frame) -> Mapping[str, Found]:
        """Every key point that it has a confidence for."""
        ...


def evaluate(
    states: Sequence[RoomState],
    seers: Mapping[str, Seer],
    *,
    pictures: int,
    seed: int,
    say: Callable[[str], None] = lambda text: None,
) -> dict[str, Tally]:
    """Let everyone see the same pictures.

    Args:
        states: all there are; those for tests are taken.
        seers: by name.
        pictures: of each kind of state and each look, each tone of skin and each light.
        seed: of the pictures.
        say: told of progress.

    Returns:
        A tally for each of `seers`.
    """
    tallies = {name: Tally() for name in seers}
    for group, (part, look) in SETS.items():
        mine = chosen_states(states, part)
        for k, kind in enumerate(KINDS):
            if not any(state.kind == kind for state in mine):
                continue
            for n in range(pictures):
                picture = draw_picture(mine, part, seed, 1000 * k + n, look=look, kind=kind)
                for name, seer in seers.items():
                    _gown(tallies[name], seer, picture, group)
            say(f"{group}, {kind}: {pictures} pictures")
    mine = chosen_states(states, "test")
    for group, drawn in _persons().items():
        for n in range(pictures):
            kind = "laid" if n % 2 else "worn"
            picture = draw_picture(mine, "test", seed, 9000 + n, look=RANDOM, kind=kind, camera="head", **drawn)
            for name, seer in seers.items():
                _arms(tallies[name], seer, picture, group)
        say(f"arms, {group}: {pictures} pictures")
    for n in range(2 * pictures):
        picture = draw_picture(mine, "test", seed, 20000 + n, look=RANDOM, gown=False)
        for name, seer in seers.items():
            for side in SIDES:
                tallies[name].hits["no gown, corner"].append(seer.corner(picture.frame, side, None) is not None)
    return tallies


def _persons() -> dict[str, dict]:
    skins = {f"skin {tone}": {"skin": tone, "light": "neutral"} for tone in range(1, 11)}
    return skins | {f"{light} light": {"light": light} for light in LIGHTS}


def _gown(tally: Tally, seer: Seer, picture: Picture, group: str) -> None:
    """Score surfaces, places, corners, straps and sides of one picture."""
    frame, truth, kind = picture.frame, picture.labels, picture.state.kind
    start = time.process_time()
    surfaces = seer.surfaces(frame)
    tally.values["ms surfaces"].append(1e3 * (time.process_time() - start))
    true, mine = _is_gown(truth.surface), _is_gown(surfaces)
    tally.overlap(f"gown, {group}, {kind}", mine, true)
    tally.overlap(f"skin, {group}", surfaces == SKIN, truth.surface == SKIN)
    tally.overlap(f"binding, {group}", _is_binding(surfaces), _is_binding(truth.surface))
    sure, places = seer.confidence(frame), seer.sheet(frame)
    if sure is not None:
        tally.confidence("surface", sure[::4, ::4].ravel(), (surfaces == truth.surface)[::4, ::4].ravel())
    if places is not None and true.sum() > 50:
        away = np.linalg.norm(places - truth.sheet, axis=2)[true]
        tally.values[f"sheet, {group}, {kind}"].append(float(np.median(away)))
    _side(tally, surfaces, truth.surface, f"side, {group}, {kind}")
    _places(tally, seer, picture, group)
    for name, (place, confidence) in seer.key_points(frame).items():
        k = KEY_POINTS.index(name)
        right = truth.seen[k] != ABSENT and np.linalg.norm(place - truth.points_in_map[k]) < KEY_POINT
        tally.confidence("key point", np.array([confidence]), np.array([right]))


def _side(tally: Tally, mine: np.ndarray, true: np.ndarray, name: str) -> None:
    """Whether the side is right by area, where the truth is mostly one side and enough of it shows."""
    areas = [int((labels == side).sum()) for labels in (true, mine) for side in (OUTSIDE, INSIDE)]
    if max(areas[:2]) > 400 and min(areas[:2]) < 0.2 * max(areas[:2]):
        tally.hits[name].append((areas[2] > areas[3]) == (areas[0] > areas[1]) and max(areas[2:]) > 0)


def _places(tally: Tally, seer: Seer, picture: Picture, group: str) -> None:
    frame, truth, kind = picture.frame, picture.labels, picture.state.kind
    rng = np.random.default_rng([picture.state.seed, len(group)])
    hook = truth.points_in_map[KEY_POINTS.index("hook")] if kind == "hung" else None
    for side in SIDES:
        for what in ("corner", "strap"):
            k = KEY_POINTS.index(f"{what}_{side}")
            shows = truth.seen[k] == SHOWN and frame.camera != "head"
            if what == "corner":
                found = seer.corner(frame, side, hook) if kind in ("hung", "held") else None
                asked = kind in ("hung", "held")
            else:
                asked = kind == "laid" and shows
                rim = truth.points_in_map[KEY_POINTS.index(f"armhole_{side}")]
                found = seer.strap(frame, side, rim + rng.normal(0, TOLD, 3)) if asked else None
            if not asked:
                continue
            away = np.inf if found is None else float(np.linalg.norm(found[0] - truth.points_in_map[k]))
            if truth.seen[k] == SHOWN:
                tally.hits[f"{what}, {group}, {kind}, {'head' if frame.camera == 'head' else 'hand'}"].append(
                    away < NEAR[what]
                )
            if found is not None:
                tally.hits[f"{what} told, {group}, {kind}"].append(away < NEAR[what])


def _arms(tally: Tally, seer: Seer, picture: Picture, group: str) -> None:
    """Distance of every joint in the picture, shown and covered apart; a joint that is not found counts as far away."""
    truth = picture.labels
    for n, side in enumerate(SIDES):
        found = seer.arm(picture.frame, side)
        for j, joint in enumerate(JOINTS):
            k = KEY_POINTS.index(f"{joint}_{side}")
            if truth.seen[k] == ABSENT:
                continue
            shown = truth.seen[k] == SHOWN
            there = found is not None and bool(found[1][j])
            away = float(np.linalg.norm(found[0][j] - picture.state.arms[n, j])) if found and there else np.inf
            tally.values[f"joint, {group}, {'shown' if shown else 'covered'}"].append(away)
            tally.hits[f"joint found, {group}"].append(there)


def _is_gown(surfaces: np.ndarray) -> np.ndarray:
    return (surfaces != OTHER) & (surfaces != SKIN)


def _is_binding(surfaces: np.ndarray) -> np.ndarray:
    return _is_gown(surfaces) & (surfaces != OUTSIDE) & (surfaces != INSIDE)
