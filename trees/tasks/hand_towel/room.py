"""The room of `hand_towel`, and what is asked of a run there: truth, which the tree never sees."""

from __future__ import annotations

import numpy as np

from ....sim.abilities import SupportsObjects
from ....sim.evaluate.rays import meets
from ....sim.evaluate.run_record import Checks, Judgement, RunRecord
from ....sim.scene.objects import Sheet
from ....sim.world import SIDES

TOWEL = (0.30, 0.50)  # [m]
HOOK = (2.7, 0.4, 1.50)  # before the waypoint `rail` [m]
FABRIC = (194.0, 218.0, 240.0)  # light blue, as the laundry's other fabric
HAND = (2.1, 2.9)  # part of the person's hand that counts: 2 wrist, 3 fingertip
ABOVE = 0.06  # the towel lies on the hand where it is this near to the skin [m]
COVERED = 0.7  # least share of the hand under the towel
LIES = 2.0  # so long it has to, in the end, and nobody holds it [s]
OFF_THE_FACE = 0.15  # [m]


def scene(world: SupportsObjects, seed: int) -> None:
    """A towel on a hook, and no gown."""
    rng = np.random.default_rng([seed, 18])
    x, y = HOOK[:2] + rng.uniform(-0.08, 0.08, size=2)
    world.remove_gown()
    world.add(
        Sheet(
            name="towel",
            size=TOWEL,
            position_in_map=(x, y, HOOK[2]),
            yaw=float(rng.uniform(-0.5, 0.5)),
            hung_by=(0.5, 0.0),
            mass=0.2,
            friction=0.8,
            colour=FABRIC,
        )
    )


def judge(record: RunRecord) -> Judgement:
    """The towel lies across the person's hand, nobody holds it, and nobody is harmed."""
    checks = Checks(record)
    side = SIDES.index(record.parameters["arm"])
    towel, faces = record.object("towel"), record.array("object_towel_faces")
    rest = record.t >= record.t[-1] - LIES
    shares = [
        covered(towel[k], faces, record.arms[k, side], float(record.arm_radii[side, 2])) for k in np.flatnonzero(rest)
    ]
    checks.at_least("hand_covered", min(shares), COVERED, "1")
    checks.that(not record.holds_cloth[rest].any(), "the robot holds the towel in the end")
    face = record.rows.face[:3]
    checks.at_least("towel_to_face", float(np.linalg.norm(towel - face, axis=2).min()), OFF_THE_FACE, "m")
    checks.arms_lie()
    checks.unharmed()
    return checks.judgement()


def covered(vertices: np.ndarray, faces: np.ndarray, arm: np.ndarray, radius: float) -> float:
    """Share of the top of a hand that lies under a sheet.

    Args:
        vertices: (V, 3) of the sheet [m].
        faces: (F, 3) of it.
        arm: (4, 3) shoulder, elbow, wrist, fingertip [m].
        radius: of the hand [m].
    """
    up = np.array((0.0, 0.0, 1.0))
    skin = [arm[2] + (place - 2.0) * (arm[3] - arm[2]) + radius * up for place in np.linspace(*HAND, 9)]
    return float(np.mean([len(meets(vertices, faces, point, up, radius, ABOVE)[0]) > 0 for point in skin]))
