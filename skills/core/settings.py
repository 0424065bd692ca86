"""Numbers that a run sets otherwise than its tree does: `--set present_sleeve.max_load=3.5`, or a tuning file."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping
from typing import Any

from ...sim.errors import CaretreeError
from ...sim.quantity import Quantities, QuantityError, changed, float_of

TUNING = "tuning"  # the input port of a leaf's numbers


def setting_name(kind: type) -> str:
    """How a skill is called where its numbers are set: `PresentSleeve` -> `present_sleeve`."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", kind.__name__).lower()


class SettingError(CaretreeError):
    """A number was set for a run that the tree does not have, or to something it cannot be."""


class Settings:
    """Values by skill and number; they win over what the tree gives its leaves.

    Args:
        values: skill (`present_sleeve`) -> number (`max_load`) -> value.
    """

    def __init__(self, values: Mapping[str, Mapping[str, Any]] | None = None) -> None:
        self.values: dict[str, dict[str, Any]] = {skill: dict(found) for skill, found in (values or {}).items()}
        self._met: dict[str, bool] = {}  # skills that were built -> whether they have numbers

    def applied(self, kind: type, bindings: Mapping[str, Any]) -> dict[str, Any]:
        """What of `bindings` (port -> constant or key) of a leaf of class `kind` was set otherwise for this run.

        A number that is an input itself (`max_load` of `PresentSleeve`) is set as well as those of its tuning.

        Raises:
            SettingError: a number that it does not have, or of another type.
        """
        try:
            return self._applied(kind, bindings)
        except QuantityError as error:
            raise SettingError(f"the setting for {setting_name(kind)} does not fit: {error}") from error

    def _applied(self, kind: type, bindings: Mapping[str, Any]) -> dict[str, Any]:
        name, tuning = setting_name(kind), bindings.get(TUNING)
        ports = {port for port, value in bindings.items() if isinstance(value, float) and port != TUNING}
        self._met[name] = bool(ports) or isinstance(tuning, Quantities)
        values = self.values.get(name, {})
        found: dict[str, Any] = {
            port: float_of(f"{name}.{port}", value) for port, value in values.items() if port in ports
        }
        rest = {number: value for number, value in values.items() if number not in ports}
        if rest and isinstance(tuning, Quantities):
            found[TUNING] = changed(tuning, rest, also=sorted(ports))
        elif rest and ports:  # else check() tells which skills have numbers
            raise QuantityError(f"{name} has no number {next(iter(rest))!r}; there are {', '.join(sorted(ports))}")
        return found

    def check(self) -> None:
        """Refuse numbers of skills that the tree, once built, turned out not to have.

        Raises:
            SettingError: there is such a skill.
        """
        known = sorted(name for name, tunable in self._met.items() if tunable)
        for name in self.values:
            if name not in known:
                near = difflib.get_close_matches(name, known, n=1)
                hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(known) or 'none'}"
                raise SettingError(f"this task has no skill {name!r} with numbers to set; {hint}")
