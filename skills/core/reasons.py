"""Why a skill failed: the value is the sentence the operator reads, the name is what recoveries are chosen by."""

from __future__ import annotations

import enum
from dataclasses import dataclass

from ...sim.world import EmergencyStop, SensorLost, SensorStale


class Reason(enum.Enum):
    """Every cause of failure that a tree can react to."""

    UNREACHABLE = "The hand cannot reach the place it was asked to go to."
    PATH_BLOCKED = "There is no free way for the base to the waypoint."
    NOTHING_SEEN = "The camera does not show what was looked for."
    GRASP_MISSED = "The fingers closed on nothing."
    MULTI_LAYER = "The fingers hold more than one layer of cloth."
    WRONG_SIDE = "The gown shows the wrong side."
    CLOTH_SLIPPED = "The cloth slipped out of the fingers."
    SLEEVE_MISSED = "The sleeve is not over the person's hand."
    SLEEVE_FOLDED = "The sleeve does not open towards the person's hand."
    SLEEVE_LOW = "The sleeve does not reach far enough up the person's arm."
    SLEEVE_BESIDE = "The sleeve lies beside the person's arm."
    COLLAR_ASIDE = "The collar does not lie in the middle between the person's shoulders."
    FACE_COVERED = "The gown lies over the person's face."
    SLEEVE_CAUGHT = "The sleeve is caught on the person's arm."
    ARM_LOST = "The person's arm is no longer tracked."
    ARM_COVERED = "The gown lies over the arm that is to be dressed."
    ARM_SLIPPED = "The person's arm slipped out of the grip."
    FORCE_LIMIT = "The load on a hand passed its limit."
    SPEED_LIMIT = "A hand moved faster than is allowed near the person."
    TIMEOUT = "It took longer than allowed."
    SENSOR_LOST = "A sensor gave nothing."
    SENSOR_STALE = "A sensor repeats old values."
    WORLD_LOST = "The robot no longer answers, or its clock stands still."
    EMERGENCY_STOP = "The emergency stop is pressed: the fingers stay as they are."
    COMMAND_LOST = "A command was sent and nothing moved."
    PERSON_MOVED = "The person is no longer where they were seen."
    MOTION_BLOCKED = "A motion did not come to its end or would not stop."
    PRECONDITION = "The stage could not begin because what it needs does not hold."
    INTERRUPTED = "The operator interrupted the run."
    RECORD_LOST = "The record can no longer be written."
    DISPLAY_LOST = "The run can no longer be shown."
    INTERNAL_ERROR = "The program made an error."


def reason_of(error: SensorLost | EmergencyStop) -> Reason:
    """What an error of the world means for a tree."""
    if isinstance(error, EmergencyStop):
        return Reason.EMERGENCY_STOP
    return Reason.SENSOR_STALE if isinstance(error, SensorStale) else Reason.SENSOR_LOST


@dataclass(frozen=True)
class Failure:
    """One failure on its way up the tree.

    Attributes:
        reason: what recoveries are chosen by.
        detail: numbers and names for the log, one clause; may be empty.
        node: name of the node it came from.
    """

    reason: Reason
    detail: str = ""
    node: str = ""

    def sentence(self) -> str:
        """What the operator reads."""
        where = f" [{self.node}]" if self.node else ""
        detail = f" {self.detail}" if self.detail else ""
        ended = self.reason is not Reason.INTERNAL_ERROR or not detail or detail.endswith((".", "!", "?"))
        return f"{self.reason.value}{where}{detail}{'' if ended else '.'}"


class SkillFailure(Exception):  # noqa: N818 it is the outcome of a skill, not a defect
    """Raised inside a skill to end it as failed.

    Args:
        reason: why.
        detail: one clause for the log.
    """

    def __init__(self, reason: Reason, detail: str = "") -> None:
        if not isinstance(reason, Reason):
            raise TypeError(f"SkillFailure takes a Reason such as Reason.GRASP_MISSED, not {reason!r}")
        super().__init__(f"{reason.value} {detail}".strip())
        self.reason = reason
        self.detail = detail
