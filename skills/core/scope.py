"""A part of a tree whose leaves share the beginning of their names and the wiring of their ports.

    arm = Scope(context, "right arm", keys=("hold", "grip"), side="right", hand="left")
    LiftArm("lift", arm)                  # is named "right arm/lift"; side, hand and hold are wired
    PresentSleeve("present", arm)         # reads the hold that LiftArm wrote
    LaySleeve("lay", arm, hold=None)      # what is given wins

A port is wired when the scope has a key or a constant of its name.  Keys are the scope's own: `hold` of another
arm's scope is another value.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from .context import Context
from .ports import Input, Key, PortError, ports_of


class Scope:
    """What leaves are built with in place of the context.

    Args:
        context: of the run, or the scope around this one, whose keys and constants hold here too.
        name: begins the names of the leaves; empty to add wiring only.
        keys: names of values that leaves hand on to each other here.
        **constants: for every input of that name.

    Attributes:
        context: of the run.
        prefix: of the leaves' names.
    """

    def __init__(self, context: Context | Scope, name: str = "", *, keys: Iterable[str] = (), **constants: Any) -> None:
        outer = context if isinstance(context, Scope) else None
        self.context: Context = context.context if isinstance(context, Scope) else context
        self.prefix = (outer.prefix if outer else "") + (f"{name}/" if name else "")
        own = {key: self.key(key) for key in keys}
        if both := sorted(own.keys() & constants.keys()):
            raise PortError(f"{both[0]!r} of scope {self.prefix!r} cannot be both a key and a constant")
        self._wiring: dict[str, Any] = {**(outer._wiring if outer else {}), **own, **constants}

    @classmethod
    def of(cls, context: Context | Scope) -> Scope:
        """The scope itself, or a nameless one without wiring around a context."""
        return context if isinstance(context, Scope) else cls(context)

    def key(self, name: str) -> Key:
        """The key `name` of this scope."""
        return Key("_".join(filter(None, [*self.prefix.replace(" ", "_").split("/"), name])))

    def __getitem__(self, name: str) -> Any:
        """The key or constant called `name`, to wire it to a port of another name."""
        try:
            return self._wiring[name]
        except KeyError:
            known = ", ".join(sorted(self._wiring)) or "nothing"
            raise PortError(f"scope {self.prefix!r} has no {name!r}; it has {known}") from None

    def wired(self, kind: type, given: dict[str, Any]) -> dict[str, Any]:
        """`given` and, for the other ports of the skill class `kind`, what this scope has by their name."""
        found = {
            name: self._wiring[name]
            for name, port in ports_of(kind)
            if name in self._wiring and (isinstance(port, Input) or isinstance(self._wiring[name], Key))
        }
        return {**found, **given}
