"""Carrying gripped cloth on a straight way, no farther than it comes along."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...perception.image.cloud import unit
from ...sim.quantity import Quantities, quantity
from ...sim.world import SIDES, HandTwist, Side
from ..core.skill import Skill
from .hands import cloth_load, hand_now


@dataclass(frozen=True, kw_only=True)
class Carry(Quantities):
    """How cloth is carried near the person."""

    speed: float = quantity(0.08, "m/s", "of the hand that holds the cloth", "choice: slow at the neck")
    max_load: float = quantity(
        6.0, "N", "of the cloth, at which it is carried no farther", "measured: 5 to 6 N bring a collar to the midline"
    )
    touch_load: float = quantity(3.0, "N", "upwards, of a hand that touches the body", "choice: cloth never pushes up")
    tolerance: float = quantity(0.01, "m", "to the end of a way", "choice: the width of a thread")
    timeout_factor: float = quantity(
        2.5, "1", "of the time that a way takes at full speed", "choice: room for a guard that slows it down"
    )


def carry(skill: Skill, hand: Side, goal: np.ndarray, law: Carry, speed: float | None = None) -> Iterator[None]:
    """Straight to `goal`, or as far as the cloth comes, or until the hand touches the body.

    Args:
        skill: that carries.
        hand: that holds the cloth.
        goal: (3,) of the hand in the map [m].
        law: speed and loads.
        speed: instead of the law's [m/s].
    """
    n, speed = SIDES.index(hand), law.speed if speed is None else speed
    way = float(np.linalg.norm(goal - hand_now(skill, hand)[:3, 3]))
    end = skill.now() + law.timeout_factor * way / speed
    while skill.now() < end:
        rest = goal - skill.world.observe().pose_hand_in_map[n, :3, 3]
        load = cloth_load(skill, hand)
        pulls = np.linalg.norm(load) > law.max_load and load @ rest < 0.0
        if np.linalg.norm(rest) < law.tolerance or pulls or load[2] > law.touch_load:
            return
        skill.world.send(HandTwist(side=hand, twist_in_map=np.append(speed * unit(rest), np.zeros(3))))
        yield
