"""How hard a world is made: `easy`, or named difficulties added to it one at a time.

    easy                          the friendliest world
    easy+falling_arms             that, with arms that fall and elbows that bend
    hard                          with every difficulty there is

How large each of them is, only the simulation knows: `scene/difficulties.py`.
"""

from __future__ import annotations

from dataclasses import dataclass

from .errors import CaretreeError

EASY, HARD = "easy", "hard"
DIFFICULTIES: tuple[str, ...] = ("falling_arms",)


@dataclass(frozen=True)
class WorldKind:
    """Which difficulties a world has.

    Attributes:
        difficulties: in the order of `DIFFICULTIES`.
    """

    difficulties: tuple[str, ...] = ()

    @classmethod
    def named(cls, name: str) -> WorldKind:
        """The kind called `name`: `easy`, `hard`, or `easy+DIFFICULTY+...`.

        Raises:
            CaretreeError: there is no such kind.
        """
        if name == HARD:
            return cls(DIFFICULTIES)
        first, *added = name.split("+")
        unknown = [part for part in added if part not in DIFFICULTIES]
        if first != EASY or unknown or len(set(added)) < len(added):
            raise CaretreeError(
                f"unknown world kind {name!r}; there are {EASY}, {HARD}, and {EASY}+NAME+... with each of "
                f"{', '.join(DIFFICULTIES)} at most once"
            )
        return cls(tuple(part for part in DIFFICULTIES if part in added))

    @property
    def name(self) -> str:
        """What `named` reads, without `hard`: a record must not grow with the difficulties that come later."""
        return "+".join((EASY, *self.difficulties))

    def has(self, difficulty: str) -> bool:
        """Whether the world has a difficulty of this name.

        Raises:
            CaretreeError: there is no such difficulty.
        """
        if difficulty not in DIFFICULTIES:
            raise CaretreeError(f"unknown difficulty {difficulty!r}; there are {', '.join(DIFFICULTIES)}")
        return difficulty in self.difficulties


EASY_KIND = WorldKind()
