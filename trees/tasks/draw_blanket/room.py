"""The room of `draw_blanket`, and what is asked of a run there: truth, which the tree never sees."""

from __future__ import annotations

import numpy as np

from ....sim.abilities import SupportsObjects
from ....sim.evaluate.rays import meets
from ....sim.evaluate.run_record import Checks, Judgement, RunRecord
from ....sim.scene.objects import Sheet
from ....sim.scene.scene import BED_TOP

BLANKET = (1.08, 0.90)  # of a lap blanket: one that hung farther over the foot of the bed slid off it [m]
SPACING = 0.06  # of its grid [m]
EDGE = 0.24  # y of its upper edge at the start: over the thighs, the hands above it [m]
FALLS_FROM = 0.22  # over the mattress, at which it is let go of [m]
WOOL = (194.0, 218.0, 240.0)  # light blue, as the laundry's other fabric
CHEST = (0.10, 0.36)  # from the line of the shoulders down to the edge in the end, at least and at most [m]
ABOVE = 0.10  # the blanket covers the trunk where it is this near to the skin [m]
COVERED = 0.9  # least share of the trunk below the chest that is covered
OFF_THE_FACE = 0.12  # [m]
RESTS = 2.0  # so long nobody holds it in the end [s]
MIDDLE = 0.3  # half of the edge's width that counts, over the body [m]


def scene(world: SupportsObjects, seed: int) -> None:
    """A blanket over the person's legs, and no gown."""
    rng = np.random.default_rng([seed, 20])
    x, y = rng.uniform(-0.05, 0.05), EDGE + rng.uniform(-0.03, 0.05)
    world.remove_gown()
    world.add(
        Sheet(
            name="blanket",
            size=BLANKET,
            spacing=SPACING,
            position_in_map=(float(x), float(y) + BLANKET[1] / 2, BED_TOP + FALLS_FROM),
            yaw=float(rng.uniform(-0.06, 0.06)),
            mass=0.6,
            friction=0.9,
            colour=WOOL,
        )
    )


def judge(record: RunRecord) -> Judgement:
    """The blanket lies on the person up to the chest, straight, nobody holds it, and nobody is harmed."""
    checks = Checks(record)
    blanket, faces = record.object("blanket"), record.array("object_blanket_faces")
    shoulders = record.arms[-1, :, 0].mean(axis=0)
    columns = round(BLANKET[0] / SPACING) + 1
    edge = blanket[-1, :columns]
    below = edge[np.abs(edge[:, 0] - shoulders[0]) < MIDDLE, 1] - shoulders[1]
    least, most = CHEST
    checks.at_least("edge_below_shoulders", float(below.min(initial=np.inf)), least, "m")
    checks.at_most("edge_below_shoulders_at_most", float(below.max(initial=-np.inf)), most, "m")
    front = record.array("torso_front")[-1].astype(float)
    front = front[front[:, 1] - shoulders[1] > most]
    hit = [len(meets(blanket[-1], faces, p[:3], p[3:], ABOVE, ABOVE)[0]) > 0 for p in front]
    checks.at_least("trunk_covered", float(np.mean(hit)), COVERED, "1")
    rest = record.t >= record.t[-1] - RESTS
    checks.that(not record.holds_cloth[rest].any(), "the robot holds the blanket in the end")
    face = record.rows.face[:3]
    checks.at_least("blanket_to_face", float(np.linalg.norm(blanket - face, axis=2).min()), OFF_THE_FACE, "m")
    checks.arms_lie()
    checks.unharmed()
    return checks.judgement()
