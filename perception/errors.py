"""How perception says that it has nothing to say."""

from __future__ import annotations

import enum

from ..sim.errors import CaretreeError


class Problem(enum.Enum):
    """Kinds of failure; the value is the sentence the operator reads."""

    NOTHING_SEEN = "what was looked for is not in the image"
    NO_DEPTH = "it is in the image but the camera gave no depth for it"
    HIDDEN = "something else is in front of it"
    OUT_OF_REACH = "nothing of it lies where it was asked for"
    ARM_LOST = "the arm has not been seen for so long that its position is too uncertain"


class PerceptionFailure(CaretreeError):  # noqa: N818 - the name the skills' contract fixed
    """Raised instead of returning an estimate.

    Attributes:
        problem: the kind, for recoveries to choose by.
        what: what was looked for.
    """

    def __init__(self, problem: Problem, what: str) -> None:
        super().__init__(f"{what}: {problem.value}")
        self.problem = problem
        self.what = what

    @property
    def kind(self) -> str:
        """Machine-readable name of the problem, such as `nothing_seen`."""
        return self.problem.name.lower()
