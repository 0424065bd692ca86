"""What was lost for a moment is waited for, what the guard stopped stands still, and then it is done once more."""

from __future__ import annotations

from collections.abc import Callable

from py_trees.behaviour import Behaviour

from ....skills.core.context import Context
from ....skills.core.reasons import Reason
from ....skills.core.scope import Scope
from ....skills.hold_still import HoldStill
from ...nodes.composers import commanding
from ...nodes.decorators import RecoverBy
from .tuning import DRESSING

SIGHT: tuple[Reason, ...] = (Reason.SENSOR_LOST, Reason.SENSOR_STALE)
FOR_A_MOMENT = (*SIGHT, Reason.COMMAND_LOST)


def patient(context: Context | Scope, body: Behaviour) -> RecoverBy:
    """The body, once more when the cameras show again, where they or a command were lost; nothing is let go of."""
    reasons = FOR_A_MOMENT if commanding(body) else SIGHT
    again = dict.fromkeys(reasons, sight_again(context, body.name))
    return RecoverBy(f"{body.name}, again", body, again, attempts=DRESSING.patient_attempts)


def unhurried(hands: Scope, node: Behaviour) -> RecoverBy:
    """The node, once more from where the arms stand, when the guard has stopped them as an elbow swung out.

    Where a joint comes to its limit an elbow does so, at up to 0.4 m/s (173, 225): ended there, the fingers opened with
    an arm 0.34 m up.
    """
    name = node.name.removeprefix(hands.prefix)
    again = {Reason.SPEED_LIMIT: lambda: HoldStill(f"stand: {name}", hands, seconds=DRESSING.stopped_pause)}
    return RecoverBy(f"{node.name}, again", node, again, attempts=DRESSING.stopped_attempts)


def sight_again(context: Context | Scope, name: str) -> Callable[[], Behaviour]:
    """Builds the leaf that waits for the cameras, for a node of that name."""
    scope = Scope.of(context)
    what = {"seconds": 0.0, "all_cameras": True, "patience": DRESSING.patience}
    return lambda: HoldStill(f"see: {name.removeprefix(scope.prefix)}", scope, **what)
