"""How hard a world is made: `easy`, or named difficulties added to it one at a time.

    easy                          the friendliest world
    easy+falling_arms             that, with arms that fall and elbows that bend
    easy+camera_extrinsics        cameras are turned and shifted a little against where they should be
    easy+localisation             where the base stands in the map is known roughly, and drifts
    easy+encoders                 the zero of every joint sensor is off
    easy+late_images              images arrive late
    easy+wrench_bias              wrists feel what is not there, and part of the gripper's own weight
    easy+depth_noise              depth in steps, pixels that fly at edges, pixels without depth
    easy+thinking_time            the world goes on while the robot works through images and plans
    easy+skin_friction            cloth slides on skin as hard as cotton does
    hard                          with every difficulty there is

How large each of them is, only the simulation knows: `scene/difficulties.py`.
"""

from __future__ import annotations

from dataclasses import dataclass

from .errors import CaretreeError

EASY, HARD = "easy", "hard"
DIFFICULTIES: tuple[str, ...] = (
    "falling_arms",
    "camera_extrinsics",
    "localisation",
    "encoders",
    "late_images",
    "wrench_bias",
    "depth_noise",
    "thinking_time",
    "skin_friction",
)


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
