"""What an evaluation collects."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(kw_only=True)
class Findings:
    """Filled by one look at a record after the other.

    Attributes:
        problems: one sentence for each bound that is broken.
        numbers: name with unit -> value.
        places: name of a number -> what it was found at, and when.
    """

    problems: list[str] = field(default_factory=list)
    numbers: dict[str, float] = field(default_factory=dict)
    places: dict[str, str] = field(default_factory=dict)

    def add(self, other: Findings) -> None:
        """Take over what another look found."""
        self.problems += other.problems
        self.numbers |= other.numbers
        self.places |= other.places
