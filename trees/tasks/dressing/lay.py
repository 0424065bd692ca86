"""The stage `lay` of the dressing tree: unfold the gown and lay it on the person, outside up, arms bare."""

from __future__ import annotations

import numpy as np
from py_trees.behaviour import Behaviour

from ....skills.core.context import Context
from ....skills.core.ports import Key
from ....skills.flip_side_check import FlipSideCheck
from ....skills.lay_gown import LayGown
from ....skills.stretch_neckline import StretchNeckline
from ...nodes.composers import sequence
from ...nodes.decorators import Stage, Timeout
from .tuning import DRESSING


def unfold(context: Context) -> Behaviour:
    """The stage `lay`."""
    width = Key("neckline_width")
    return Stage(
        "B unfold",
        _holds_gown,
        Timeout(
            "B in time",
            sequence(
                "unfold and lay",
                StretchNeckline("stretch the neckline", context, width=width),
                FlipSideCheck("outside to the robot", context, min_confidence=DRESSING.laid_inside_confidence),
                LayGown("lay it on the person", context, width=width),
            ),
            seconds=DRESSING.unfold_timeout,
        ),
    )


def _holds_gown(context: Context) -> bool:
    """Both hands together carry what a gown weighs [N]."""
    return bool(-np.sum(context.world.observe().wrench_hand_in_map[:, 2]) > DRESSING.gown_weight)
