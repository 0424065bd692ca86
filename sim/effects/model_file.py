"""model.yaml: the effects a model was found to lack, checked before anything loads them."""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..extras import later
from ..yaml_text import load_yaml
from .body.body_registry import BODY_EFFECTS
from .effect import EffectError, check_values
from .joint.arm_geometry import GEOMETRY
from .joint.joint_registry import JOINT_EFFECTS
from .joint.link_inertia import BODY_PARAMETERS, BODY_TERMS

if TYPE_CHECKING:
    import yaml
else:
    yaml = later("yaml")

FORMAT = "caretree-model-1"
KEYS = (
    "format",
    "system",
    "robot",
    "mass",
    "mesh",
    "physics",
    "simulator",
    "recalibration",
    "effects",
    "name",
    "source",
    "description",
)
ENTRY_KEYS = ("name", "target", "parameters")
SYSTEMS = ("arm", "axis", "fall", "cloth", "dressing")


@dataclass(frozen=True, kw_only=True)
class EffectEntry:
    """One effect of a model file: name, what it acts on, parameter values in SI."""

    name: str
    target: str
    parameters: dict[str, float]


@dataclass(frozen=True, kw_only=True)
class EffectModel:
    """A checked model file.

    Attributes:
        system: what the effects act on.
        base: what the file says of the model underneath (robot, mass, physics).
        recalibration: changes of the model's own parameters.
        effects: effects to add.
    """

    system: str
    base: dict[str, Any]
    recalibration: tuple[EffectEntry, ...]
    effects: tuple[EffectEntry, ...]

    def require(self, system: str) -> None:
        """Refuse a file made for another system.

        Raises:
            EffectError: it was.
        """
        if self.system != system:
            raise EffectError(f"the model file is for system '{self.system}', it cannot be loaded into '{system}'")


def load_model(path: Path | str) -> EffectModel:
    """Read and check a model file.

    Raises:
        EffectError: it is missing, malformed, or names an effect or a parameter that does not fit.
    """
    path = Path(path)
    if not path.is_file():
        raise EffectError(f"{path}: no such file")
    try:
        content = load_yaml(path.read_text(encoding="utf-8"))
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        problem = getattr(error, "problem", None)
        raise EffectError(f"{path}: not YAML{f': {problem}' if problem else ''}") from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise EffectError(f"{path}: `format` must be {FORMAT}")
    system = content.get("system")
    own = system not in SYSTEMS  # then a class of the user's knows what its effects are
    if own and not (isinstance(content.get("simulator"), str) and isinstance(system, str)):
        raise EffectError(f"{path}: system is {system!r}, it must be one of {', '.join(SYSTEMS)}")
    try:
        _refuse_unknown(content, KEYS)
        effects, recalibration = (_entries(content, key) for key in ("effects", "recalibration"))
        for e in (*effects, *(recalibration if system == "dressing" else ())) if not own else ():
            check_effect(system, e)
    except EffectError as error:
        raise EffectError(f"{path}: {error}") from None
    base = {k: v for k, v in content.items() if k not in ("format", "system", "effects", "recalibration")}
    return EffectModel(system=system, base=base, recalibration=recalibration, effects=effects)


def save_model(path: Path, content: dict[str, Any]) -> None:
    """Write a model file from plain values (`system`, `effects`, `recalibration`, base)."""
    path.write_text(yaml.safe_dump({"format": FORMAT, **content}, sort_keys=False), encoding="utf-8")


def _refuse_unknown(given: dict[Any, Any], known: tuple[str, ...]) -> None:
    for key in given:
        if key not in known:
            near = difflib.get_close_matches(str(key).lower(), known, n=1, cutoff=0.5)
            meant = f"did you mean {near[0]}? " if near else ""
            raise EffectError(f"there is no key {key!r}, {meant}(there are {', '.join(known)})")


def _entries(content: dict[str, Any], key: str) -> tuple[EffectEntry, ...]:
    found = content.get(key) or []
    if not isinstance(found, list):
        raise EffectError(f"`{key}` must be a list, it is {found!r}")
    return tuple(_entry(e) for e in found)


def _entry(e: Any) -> EffectEntry:
    if not isinstance(e, dict) or not isinstance(e.get("name"), str) or not isinstance(e.get("parameters"), dict):
        raise EffectError(f"an effect needs name, target and parameters, this one is {e!r}")
    _refuse_unknown(e, ENTRY_KEYS)
    try:
        values = {str(k): float(v) for k, v in e["parameters"].items()}
    except (TypeError, ValueError, OverflowError):
        raise EffectError(f"effect {e['name']}: parameters must be numbers, they are {e['parameters']!r}") from None
    if not all(math.isfinite(v) for v in values.values()):
        raise EffectError(f"effect {e['name']}: parameters must be finite numbers, they are {e['parameters']!r}")
    return EffectEntry(name=e["name"], target=str(e.get("target", "")), parameters=values)


def check_effect(system: str, e: EffectEntry) -> None:
    """Refuse an effect that does not exist for a system or has values it cannot have.

    Raises:
        EffectError: one sentence.
    """
    if system in ("arm", "axis"):
        if e.name in BODY_TERMS:
            wanted = {p.name for p in BODY_PARAMETERS}
            if set(e.parameters) != wanted:
                raise EffectError(f"effect {e.name} has parameters {sorted(e.parameters)}, it takes {sorted(wanted)}")
            return
        if e.name in GEOMETRY and system == "arm":
            told = tuple(p for p in GEOMETRY[e.name] if p.name in e.parameters) or GEOMETRY[e.name][:1]
            check_values(e.name, e.parameters, told, GEOMETRY[e.name])
            return
        registry: dict[str, Any] = dict(JOINT_EFFECTS)
    elif system == "fall":
        registry = dict(BODY_EFFECTS)
    elif system == "dressing":
        from .dressing.dressing_registry import DRESSING_EFFECTS

        if e.name in DRESSING_EFFECTS:
            DRESSING_EFFECTS[e.name].check(e.target, e.parameters)
            return
        registry = dict(DRESSING_EFFECTS)
    else:
        from .cloth.cloth_registry import CLOTH_EFFECTS

        registry = dict(CLOTH_EFFECTS)
    if e.name not in registry:
        names = ", ".join([*registry, *(GEOMETRY if system == "arm" else ())])
        raise EffectError(f"effect '{e.name}' does not exist for system {system}, it must be one of {names}")
    registry[e.name].check(e.parameters)
