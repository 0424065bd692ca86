"""The stage `lay` of the dressing tree: unfold the gown and lay it on the person, outside up, arms bare."""

from __future__ import annotations

import numpy as np

from ....skills.core.context import Context
from ....skills.core.scope import Scope
from ....skills.flip_side_check import FlipSideCheck
from ....skills.lay_gown import LayGown
from ....skills.stretch_neckline import StretchNeckline
from ...nodes.decorators import Stage, timed_stage
from .tuning import DRESSING


def lay(context: Context) -> Stage:
    """The stage `lay`."""
    gown = Scope(context, "gown", keys=("width",))
    return timed_stage(
        "lay",
        StretchNeckline("stretch the neckline", gown),
        FlipSideCheck("outside to the robot", gown, min_confidence=DRESSING.laid_inside_confidence),
        LayGown("lay it on the person", gown),
        precondition=holds_gown,
        seconds=DRESSING.lay_timeout,
    )


def holds_gown(context: Context) -> bool:
    """Both hands together carry what a gown weighs [N]."""
    return bool(-np.sum(context.world.observe().wrench_hand_in_map[:, 2]) > DRESSING.gown_weight)
