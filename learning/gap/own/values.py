"""A model file back in the user's simulator: the values to predict with."""

from __future__ import annotations

from pathlib import Path

from ....sim.effects.model_file import load_model
from ..errors import GapError
from .simulation import Values
from .system import System, check_system


def values_of(path: Path | str, system: System) -> Values:
    """Every parameter of a system and the value a model file gives it, 0 where it names none.

    Raises:
        EffectError: the file is no model file.
        GapError: it is for another system, or names what this one does not have.
    """
    model, effects = load_model(path), {e.key: e for e in check_system(system).effects}
    if model.system != system.name:
        raise GapError(f"{path}: the model file is for system '{model.system}', not for '{system.name}'")
    values = {p.name: 0.0 for e in system.effects for p in e.parameters}
    values |= {p.name: 0.0 for p in system.start}
    for entry in (*model.recalibration, *model.effects):
        effect = effects.get((entry.name, entry.target))
        if effect is None:
            names = ", ".join(f"{n} on {t}" for n, t in effects)
            raise GapError(f"{path}: {entry.name} on {entry.target} is no effect of {system.name}, it has {names}")
        bounds = {p.name: p for p in effect.parameters}
        for name, x in entry.parameters.items():
            if name not in bounds or not bounds[name].lower <= x <= bounds[name].upper:
                raise GapError(
                    f"{path}: {name} = {x:g} of {entry.name} is none of {', '.join(bounds)} within its bounds"
                )
            values[name] = x
    return values
