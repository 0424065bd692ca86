"""Whether hands that have let go return to the ready posture, and what happens where no way there is found."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Literal

from ..core.reasons import Reason, SkillFailure
from ..core.skill import Skill
from ..motion.errors import MotionError

Ready = Literal["always", "if possible", "never"]


def ready_or_not(skill: Skill, ready: str, let_go: Callable[[bool], Iterator[None]]) -> Iterator[None]:
    """Let go as `ready` says; if possible means that after a failure all is done once more without that posture.

    Args:
        skill: that moves.
        ready: one of `Ready`: whether the hands go to the ready posture.
        let_go: the whole motion, told whether it ends in the ready posture.

    Raises:
        SkillFailure: a command was lost, or the motion did not come to rest; where `if possible`, the second time.
        MotionError: no way was found; where `if possible`, the second time.
    """
    if ready != "if possible":
        yield from let_go(ready == "always")
        return
    try:
        yield from let_go(True)
    except (MotionError, SkillFailure):
        skill.note("leaves the arms as they are")
        skill.world.stop()
        patience = skill.context.lease.patience  # what any motion is given to come to rest
        yield from skill.until(skill.context.guard.still, timeout=patience, reason=Reason.MOTION_BLOCKED)
        yield from let_go(False)
