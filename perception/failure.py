"""What an estimator raises when an image does not hold the answer."""

from __future__ import annotations

from typing import Literal

from ..sim.errors import CaretreeError

FailureKind = Literal["nothing_seen", "arm_lost", "sensor_stale", "sensor_lost", "person_moved", "cloth_slipped"]


class PerceptionFailure(CaretreeError):  # noqa: N818 it is an outcome, not a defect
    """An estimate could not be made.

    Args:
        kind: which of the reasons a tree can react to (the lower-case names of skills.reasons.Reason).
        detail: one clause for the log.
    """

    def __init__(self, kind: FailureKind, detail: str = "") -> None:
        super().__init__(f"{kind}: {detail}" if detail else kind)
        self.kind = kind
        self.detail = detail
