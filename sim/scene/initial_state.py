"""States of the simulated room in which a run may begin."""

from __future__ import annotations

import enum

from ..world import WorldError


class InitialState(str, enum.Enum):
    """Where the gown is when a run begins; whatever is not on the hook has been put there by hand."""

    GOWN_ON_HOOK = "gown_on_hook"  # it hangs on its rail; the robot stands at `start`
    GOWN_IN_HANDS = "gown_in_hands"  # by both ends of the neckline, outside to the robot, which stands off the rail
    GOWN_ON_PERSON = "gown_on_person"  # on the legs, outside up, neckline at the fingertips; robot at `bed_right`
    GOWN_WORN = (
        "gown_worn"  # both arms are in their sleeves, not all of them far up, and up unless they fall; `bed_left`
    )
    GOWN_DRESSED = "gown_dressed"  # both arms are in their sleeves up to the shoulders, and lie; robot at `bed_right`

    def __str__(self) -> str:
        return self.value

    @classmethod
    def named(cls, name: str) -> InitialState:
        """The state of that name.

        Raises:
            WorldError: there is none.
        """
        if name not in tuple(cls):
            raise WorldError(f"no run begins with {name!r}; there are {', '.join(state.value for state in cls)}")
        return cls(name)
