"""Try one candidate after the other: a problem with one does not end the search, and is told where none will do.

Loop over the candidates, use each inside `with tries:` and leave the loop where it will do; behind the loop
`raise tries.last`.  The body may be part of a generator and `yield from` a motion.
"""

from __future__ import annotations

from types import TracebackType
from typing import Generic, TypeVar

E = TypeVar("E", bound=Exception)


class Tries(Generic[E]):
    """Keeps the problems of the candidates tried inside `with`, and lets every other exception pass.

    The body may return, break, continue and `yield from`: a generator that is closed there ends as usual.

    Args:
        kinds: of exceptions that only mean that this candidate will not do.

    Attributes:
        problems: what was wrong with each candidate that failed, in the order of trying.
    """

    def __init__(self, *kinds: type[E]) -> None:
        self._kinds = kinds
        self.problems: list[E] = []

    def __enter__(self) -> None: ...

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> bool:
        if not isinstance(problem, self._kinds):
            return False
        self.problems.append(problem)
        return True

    @property
    def first(self) -> E:
        """What was wrong with the first candidate.

        Raises:
            RuntimeError: no candidate has failed.
        """
        return self._problem(0)

    @property
    def last(self) -> E:
        """What was wrong with the last candidate.

        Raises:
            RuntimeError: no candidate has failed.
        """
        return self._problem(-1)

    def _problem(self, index: int) -> E:
        if not self.problems:
            raise RuntimeError("there was no candidate to try")
        return self.problems[index]
