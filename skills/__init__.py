"""Leaves of the tree, one file each, and what they share.

What authors need comes from here: `from caretree.skills import LiftArm, Navigate, Key, Reason`, and for skills of their
own `Skill, Input, Output, SkillFailure`.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .carry_sleeve import CarrySleeve as CarrySleeve
    from .check_laid_out import CheckLaidOut as CheckLaidOut
    from .check_sleeve import CheckSleeve as CheckSleeve
    from .core.context import Context as Context
    from .core.ports import Input as Input
    from .core.ports import Key as Key
    from .core.ports import Output as Output
    from .core.reasons import Reason as Reason
    from .core.reasons import SkillFailure as SkillFailure
    from .core.scope import Scope as Scope
    from .core.skill import Skill as Skill
    from .find_corner import FindCorner as FindCorner
    from .find_stand import FindStand as FindStand
    from .flip_side_check import FlipSideCheck as FlipSideCheck
    from .grasp_sleeve import GraspSleeve as GraspSleeve
    from .hold_still import HoldStill as HoldStill
    from .lay_gown import LayGown as LayGown
    from .lay_sleeve import LaySleeve as LaySleeve
    from .lift_arm import LiftArm as LiftArm
    from .look_at_person import LookAtPerson as LookAtPerson
    from .look_for_sleeve import LookForSleeve as LookForSleeve
    from .lower_arm import LowerArm as LowerArm
    from .move_joint import MoveJoint as MoveJoint
    from .navigate import Navigate as Navigate
    from .pre_grasp_manipulate import PreGraspManipulate as PreGraspManipulate
    from .present_sleeve import PresentSleeve as PresentSleeve
    from .pull_along_arm import PullAlongArm as PullAlongArm
    from .raise_corner import RaiseCorner as RaiseCorner
    from .release_arm import ReleaseArm as ReleaseArm
    from .retreat import Retreat as Retreat
    from .seat_sleeves import SeatSleeves as SeatSleeves
    from .segment_and_grasp import SegmentAndGrasp as SegmentAndGrasp
    from .spread import Spread as Spread
    from .stretch_neckline import StretchNeckline as StretchNeckline
    from .take_corner import TakeCorner as TakeCorner
    from .take_down import TakeDown as TakeDown
    from .unhook import Unhook as Unhook
    from .view_around import ViewAround as ViewAround

_HOME = {
    "CarrySleeve": ".carry_sleeve",
    "CheckLaidOut": ".check_laid_out",
    "CheckSleeve": ".check_sleeve",
    "Context": ".core.context",
    "FindCorner": ".find_corner",
    "FindStand": ".find_stand",
    "FlipSideCheck": ".flip_side_check",
    "GraspSleeve": ".grasp_sleeve",
    "HoldStill": ".hold_still",
    "Input": ".core.ports",
    "Key": ".core.ports",
    "LayGown": ".lay_gown",
    "LaySleeve": ".lay_sleeve",
    "LiftArm": ".lift_arm",
    "LookAtPerson": ".look_at_person",
    "LookForSleeve": ".look_for_sleeve",
    "LowerArm": ".lower_arm",
    "MoveJoint": ".move_joint",
    "Navigate": ".navigate",
    "Output": ".core.ports",
    "PreGraspManipulate": ".pre_grasp_manipulate",
    "PresentSleeve": ".present_sleeve",
    "PullAlongArm": ".pull_along_arm",
    "RaiseCorner": ".raise_corner",
    "Reason": ".core.reasons",
    "ReleaseArm": ".release_arm",
    "Retreat": ".retreat",
    "Scope": ".core.scope",
    "SegmentAndGrasp": ".segment_and_grasp",
    "Skill": ".core.skill",
    "SkillFailure": ".core.reasons",
    "SeatSleeves": ".seat_sleeves",
    "Spread": ".spread",
    "StretchNeckline": ".stretch_neckline",
    "TakeCorner": ".take_corner",
    "TakeDown": ".take_down",
    "Unhook": ".unhook",
    "ViewAround": ".view_around",
}
__all__ = sorted(_HOME)  # pyright: ignore[reportUnsupportedDunderAll] filled on first use


def __getattr__(name: str) -> Any:
    """Import what is asked for only then, so that `caretree --help` stays instant."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_HOME[name], __name__), name)
