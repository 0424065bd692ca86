"""A gown that hangs from one hand by one end of its neckline, drawn by seed.

It begins between both hands, at rest, is turned about the vertical, let go of with one of them, with a speed of its own
everywhere, and swings out.  The origin is the holding hand; z is up.

A *deep* grasp holds the neckline far from its ends, as a hand does that takes the gown from its hook: it hangs doubled,
and meets itself, so that layers lie on each other at both ends.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ...sim.spring.banded_cholesky import Band
from ...sim.spring.mass_spring import Springs, advance, damped, weave
from ..physics.engine.equilibrium import held_start, static_equilibrium
from .gowns import draw_gown, gown_of, held_sheet, key_of, mesh_of
from .numbers import HANG, HangNumbers

CALMED = 0.05  # the swing is damped once in this time [s]
LOOK = 4  # folds that are near each other are looked for every so many steps


@dataclass(frozen=True, kw_only=True)
class HungState:
    """One gown in one hand.

    Attributes:
        seed: that it was drawn from.
        gown: its key, see `gowns.py`.
        vertices: (V, 3), the holding hand at the origin [m].
        held: vertices in that hand.
        wanted: vertex of the other end of the neckline.
        speed: the fastest vertex when it was left to be [m/s].
        deep: whether the hand holds the neckline far from its ends, and the cloth meets itself.
    """

    seed: int
    gown: str
    vertices: np.ndarray
    held: tuple[int, ...]
    wanted: int
    speed: float = 0.0
    deep: bool = False

    @property
    def faces(self) -> np.ndarray:
        """(F, 3) of the gown."""
        return mesh_of(self.gown).faces


def hang(
    seed: int,
    gown: str | None = None,
    deep: bool = False,
    numbers: HangNumbers = HANG,
    *,
    physics: str = "identified",
) -> HungState:
    """The state of a seed: which gown, which end is held, how it was let go of.

    Args:
        seed: draws everything.
        gown: its key; None leaves its cut to the seed.
        deep: whether the hand holds the neckline far from its ends, and the cloth meets itself.
        numbers: of the swing.
        physics: of `numbers.PHYSICS`; a key says it itself.
    """
    rng = np.random.default_rng([seed, 15])
    drawn = draw_gown(rng)
    gown = key_of(gown or drawn, physics, seed)
    mesh = mesh_of(gown)
    end = int(rng.integers(2))
    corner, wanted = mesh.corners[end], mesh.corners[1 - end]
    if deep:
        away = round(numbers.deepest * len(mesh.collar))
        corner = int(np.random.default_rng([seed, 20]).choice(mesh.collar[away : len(mesh.collar) - away]))
    held = _pinched(gown, corner, rng)
    yaw = rng.uniform(-np.pi, np.pi)
    turn = np.array(((np.cos(yaw), -np.sin(yaw), 0.0), (np.sin(yaw), np.cos(yaw), 0.0), (0.0, 0.0, 1.0)))
    x = (_between_hands(gown) - _between_hands(gown)[corner]) @ turn.T
    x[list(held)] = x[corner] + numbers.gather * (x[list(held)] - x[corner])
    v = np.zeros_like(x)
    for _ in range(numbers.bulges):
        wave = rng.normal(0.0, 6.0, 3)  # a wave is about a metre long
        speed = rng.normal(0.0, numbers.swing / np.sqrt(numbers.bulges), 3)
        v += speed * np.sin(x @ wave + rng.uniform(0.0, 2.0 * np.pi))[:, None]
    v[list(held)] = 0.0
    if deep:
        return _let_go(HungState(seed=seed, gown=gown, vertices=x, held=held, wanted=wanted, deep=True), v, numbers)
    free = np.ones(len(x), bool)
    free[list(held)] = False
    springs, system = _system(gown, held, numbers)
    for _ in range(round(numbers.time / CALMED)):
        advance(springs, x, v, free, numbers.step, round(CALMED / numbers.step), system)
        v *= np.exp(-CALMED / numbers.calm)
    fastest = float(np.linalg.norm(v, axis=1).max())
    return HungState(seed=seed, gown=gown, vertices=x.astype(np.float32), held=held, wanted=wanted, speed=fastest)


def _let_go(state: HungState, v: np.ndarray, numbers: HangNumbers) -> HungState:
    """A gown that meets itself, after it has swung out from velocities (V, 3) [m/s]."""
    sheet = held_sheet(state.gown, state.held, state.vertices, True, numbers.air_drag)
    sheet.v[:] = v
    for k in range(round(numbers.time / numbers.step)):
        sheet.free_step()
        sheet.keep_apart(k % LOOK == 0)
        sheet.move_on()
        sheet.v *= np.exp(-numbers.step / numbers.calm)
    fastest = float(np.linalg.norm(sheet.v, axis=1).max())
    return replace(state, vertices=sheet.x.astype(np.float32), speed=fastest)


def _pinched(gown: str, corner: int, rng: np.random.Generator) -> tuple[int, ...]:
    """What the hand holds: the corner and one of the triangles at it."""
    faces = mesh_of(gown).faces
    mine = faces[(faces == corner).any(axis=1)]
    return tuple(sorted(int(k) for k in mine[rng.integers(len(mine))]))


@lru_cache(maxsize=8)
def _between_hands(gown: str) -> np.ndarray:
    """(V, 3) at rest between both hands [m]."""
    mesh, spec = mesh_of(gown), gown_of(gown)
    springs = weave(mesh).springs(
        mass=spec.mass, elastic=spec.elastic, bending=spec.bending, damping=spec.damping, air_drag=spec.air_drag
    )
    return static_equilibrium(springs, held_start(mesh, mesh.corners), mesh.corners)


@lru_cache(maxsize=64)
def _system(gown: str, held: tuple[int, ...], numbers: HangNumbers) -> tuple[Springs, Band]:
    mesh, spec = mesh_of(gown), gown_of(gown)
    springs = weave(mesh).springs(
        mass=spec.mass, elastic=spec.elastic, bending=spec.bending, damping=spec.damping, air_drag=numbers.air_drag
    )
    free = np.ones(len(mesh.vertices), bool)
    free[list(held)] = False
    return springs, damped(springs, free, numbers.step)
