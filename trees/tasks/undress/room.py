"""What is asked of a run of `undress`: truth, which the tree never sees."""

from __future__ import annotations

import numpy as np

from ....sim.evaluate.coverage import coverage
from ....sim.evaluate.crossings import sleeve
from ....sim.evaluate.face import face_covered
from ....sim.evaluate.limits import FACE_COVERED_MAX
from ....sim.evaluate.run_record import Checks, Judgement, RunRecord
from ....sim.world import SIDES

RESTS = 2.0  # so long nobody holds the gown in the end [s]
COVERED = 0.15  # share of the trunk's front that may lie under it in the end
ON_THE_BED = 0.05  # its middle may be this much below the mattress: what has slid to the floor is soiled [m]


def judge(record: RunRecord) -> Judgement:
    """No arm is in a sleeve, the trunk is bare, the gown lies on the bed, nobody holds it, and nobody is harmed."""
    checks = Checks(record)
    vertices, faces = record.array("vertices"), record.array("faces")
    end, ends = vertices[-1].astype(float), [0, -1]
    for n, side in enumerate(SIDES):
        armhole, cuff = (vertices[:, record.array(f"loop_{part}_{side}")][ends] for part in ("armhole", "cuff"))
        worn = sleeve(armhole.astype(float), cuff.astype(float), record.arms[ends, n])
        checks.that(worn.on[0], f"the {side} arm was in no sleeve in the beginning")
        checks.that(worn.armhole.net[-1] == worn.cuff.net[-1] == 0, f"the {side} arm is still in its sleeve")
    front = record.array("torso_front")[-1].astype(float)
    checks.at_most("trunk_covered", coverage(end, faces, front)[0], COVERED, "1")
    checks.at_least("gown_above_mattress", float(np.median(end[:, 2])) - record.bed_top, -ON_THE_BED, "m")
    rest = record.t >= record.t[-1] - RESTS
    checks.that(not record.holds_cloth[rest].any(), "the robot holds the gown in the end")
    longest, _ = face_covered(record.t, vertices, faces, record.rows.face)
    checks.at_most("face_covered", longest, FACE_COVERED_MAX, "s")
    checks.arms_lie()
    checks.unharmed()
    return checks.judgement()
