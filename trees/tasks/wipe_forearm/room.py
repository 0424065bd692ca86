"""The room of `wipe_forearm`, and what is asked of a run there: truth, which the tree never sees."""

from __future__ import annotations

import numpy as np

from ....sim.abilities import SupportsObjects
from ....sim.evaluate.run_record import Checks, Judgement, RunRecord
from ....sim.scene.objects import Box
from ....sim.world import SIDES

TABLE = (0.40, 0.40, 0.70)  # [m]
TABLE_AT = (2.7, 0.55)  # before the waypoint `rail` [m]
CLOTH = (0.09, 0.025, 0.09)  # a cloth folded to a pad that stands on its edge [m]
CLOTH_MASS = 0.1  # wet [kg]
SOFTNESS = 500.0  # of wet folded terry cloth in contact [N/m]
FABRIC = (194.0, 218.0, 240.0)  # light blue, as the laundry's other fabric
FORCE = (2.0, 5.0)  # that is asked for [N]
TOUCH = 0.3  # from which on the cloth touches the forearm [N]
WIPED = (1.2, 1.8)  # part of the forearm that is to be wiped: 1 elbow, 2 wrist
MOVES = 0.01  # of the cloth along the forearm, while it is wiped [m/s]
IN_BAND = 0.9  # least share of the wiping time in which the force is as asked for
PEAK = 10.0  # largest force on the forearm at any time [N]
BACK = 0.10  # of the cloth from where it stood, in the end [m]


def scene(world: SupportsObjects, seed: int) -> None:
    """A table with a folded cloth on it, and no gown."""
    rng = np.random.default_rng([seed, 17])
    x, y = TABLE_AT + rng.uniform(-0.03, 0.03, size=2)
    world.remove_gown()
    world.add(Box(name="table", size=TABLE, position_in_map=(x, y, TABLE[2] / 2)))
    x, y = (x, y) + rng.uniform(-0.06, 0.06, size=2)
    world.add(
        Box(
            name="cloth",
            size=CLOTH,
            position_in_map=(x, y, TABLE[2] + CLOTH[2] / 2),
            yaw=float(rng.uniform(-0.5, 0.5)),
            mass=CLOTH_MASS,
            stiffness=SOFTNESS,
            colour=FABRIC,
        )
    )


def judge(record: RunRecord) -> Judgement:
    """The forearm was wiped often enough, with a force as asked for; the cloth is back; nobody is harmed."""
    checks = Checks(record)
    side = record.parameters["arm"]
    cloth, arm = record.object("cloth"), record.arms[:, SIDES.index(side)]
    force = record.force(f"{side}_forearm")
    along = coordinates(cloth[:, :3], arm)
    length = float(np.linalg.norm(arm[0, 2] - arm[0, 1]))
    speed = np.abs(np.gradient(along, record.t)) * length
    wiping = (force > TOUCH) & (speed > MOVES) & (along > WIPED[0]) & (along < WIPED[1])
    inside = (force >= FORCE[0]) & (force <= FORCE[1])
    checks.at_least("strokes", float(strokes(along, force > TOUCH)), record.parameters["strokes"], "1")
    checks.at_least("force_in_band", float(inside[wiping].mean()) if wiping.any() else 0.0, IN_BAND, "1")
    checks.at_most("largest_force", float(force.max()), PEAK, "N")
    checks.numbers["mean_force_n"] = float(force[wiping].mean()) if wiping.any() else 0.0
    checks.at_most("cloth_from_its_place", float(np.linalg.norm(cloth[-1, :3] - cloth[0, :3])), BACK, "m")
    checks.arms_lie()
    checks.unharmed()
    return checks.judgement()


def coordinates(points: np.ndarray, arm: np.ndarray) -> np.ndarray:
    """Arm coordinates (T,) of points (T, 3) beside the forearms of `arm` (T, 4, 3): 1 elbow, 2 wrist."""
    way = arm[:, 2] - arm[:, 1]
    return 1.0 + np.einsum("td,td->t", points - arm[:, 1], way) / np.einsum("td,td->t", way, way)


def strokes(along: np.ndarray, touching: np.ndarray) -> int:
    """How often what touches went all along the wiped part, to one end or back; lifting it off begins anew."""
    count, end = 0, 0  # -1 was at the elbow's end last, 1 at the wrist's
    for place, touches in zip(along, touching, strict=True):
        if not touches:
            end = 0
            continue
        here = -1 if place < WIPED[0] else 1 if place > WIPED[1] else 0
        if here and end and here != end:
            count += 1
        end = here or end
    return count
