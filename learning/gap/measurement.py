"""A measurement set: a folder with `measurement.yaml` and one CSV, or the record of a run, per episode."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from ...sim.errors import CaretreeError
from ...sim.world import SIDES
from ...sim.yaml_text import load_yaml
from .errors import GapError
from .table import is_table, read_table, table_of

SYSTEMS = ("arm", "axis", "fall", "cloth", "dressing")
EPISODE_KEYS = ("file", "role", "phases", "pins", "mass")
RUN_KEYS = ("run", "role", "t0", "t1", "hand", "phases")  # of an episode that is the record of a run
SET_KEYS = (
    *("system", "episodes", "phases", "robot", "gravity", "mass", "diameter"),
    *("mesh", "physics", "pins", "capsules", "markers"),
)
PHASE_KEYS = ("name", "t0", "t1", "start", "end")
NOTE_KEYS = ("name", "source", "description", "notes", "license", "date", "author")  # read by people alone
ALIKE = 0.5  # of the letters: `masss` is meant as mass
LARGEST = 1e12  # of a number of a set, in SI
SHOWN = 40  # characters of a value in a message
ROLES = ("fit", "heldout", "repeat")


@dataclass(frozen=True, kw_only=True)
class Phase:
    """A named span of time, for instance a tree node.  t0, t1: [s]."""

    name: str
    t0: float
    t1: float


@dataclass(frozen=True, kw_only=True)
class Episode:
    """One recording.

    Attributes:
        name: file name without ending, unique in the set.
        file: where it was read from.
        role: `fit`, `heldout` or `repeat`.
        columns: name -> (T,), with `t`.
        phases: named spans of time in this episode.
        settings: what measurement.yaml says of this episode beside file and role.
    """

    name: str
    file: Path
    role: str
    columns: dict[str, np.ndarray]
    phases: tuple[Phase, ...] = ()
    settings: dict[str, Any] = field(default_factory=dict)

    @property
    def t(self) -> np.ndarray:
        """Time stamps, (T,) [s]."""
        return self.columns["t"]


@dataclass(frozen=True, kw_only=True)
class MeasurementSet:
    """What was measured, and what is known of the system it was measured on."""

    folder: Path
    system: str
    settings: dict[str, Any]
    episodes: tuple[Episode, ...]

    @property
    def fitted(self) -> tuple[Episode, ...]:
        """Episodes parameters may be fitted to (roles `fit` and `repeat`)."""
        return tuple(e for e in self.episodes if e.role != "heldout")

    @property
    def heldout(self) -> tuple[Episode, ...]:
        """Episodes kept for the final comparison."""
        return tuple(e for e in self.episodes if e.role == "heldout")

    def number(self, key: str, episode: Episode | None = None) -> float | None:
        """A positive setting of the set, or of one episode of it; None where the file does not give it.

        Raises:
            GapError: it is there and is not a positive number.
        """
        value = (self if episode is None else episode).settings.get(key)
        if value is None:
            return None
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value < LARGEST:
            of = f" of {episode.file.name}" if episode else ""
            raise GapError(
                f"{self.folder / 'measurement.yaml'}: {key}{of} is {str(value)[:SHOWN]}, a positive number below "
                f"{LARGEST:g} is needed"
            )
        return float(value)


def load_set(folder: Path | str, own: tuple[str, ...] = ()) -> MeasurementSet:
    """Read and check a measurement set; systems check their own columns when they are built.

    Args:
        folder: where measurement.yaml is.
        own: names of the user's own systems.

    Raises:
        GapError: anything in it cannot be used; the message names file, column and row.
    """
    folder = Path(folder)
    file = folder / "measurement.yaml"
    if not file.is_file():
        raise GapError(
            f"{file}: no such file, a measurement set is a folder with measurement.yaml and one CSV per episode"
        )
    try:
        content = load_yaml(file.read_text(encoding="utf-8"))
    except yaml.YAMLError as error:
        mark, problem = getattr(error, "problem_mark", None), getattr(error, "problem", None)
        what = f"is not YAML{f': {problem}' if problem else ''}"
        raise GapError(f"{file}: row {mark.line + 1 if mark else 1} {what}") from None
    except UnicodeDecodeError as error:
        raise GapError(f"{file}: byte {error.start + 1} is not UTF-8 text") from None
    if not isinstance(content, dict) or not content:
        what = f"holds {content!r:.40}" if content else "is empty"
        raise GapError(f"{file}: the file {what}, `system` and `episodes` are needed")
    system = content.get("system")
    if system not in (*SYSTEMS, *own):
        raise GapError(
            f"{file}: system is {system!r}, it must be one of {', '.join((*SYSTEMS, *own))} "
            "(a simulator of one's own is given with --system path.py:Class)"
        )
    listed = content.get("episodes")
    if not isinstance(listed, list) or not listed:
        raise GapError(f"{file}: `episodes` must list at least two entries with `file`")
    if len(listed) < 2:
        raise GapError(f"{file}: `episodes` lists one episode only, at least two are needed (one to fit, one held out)")
    runs = system == "dressing"
    _refuse_unknown(file, content, (*(("system", "episodes", "phases") if runs else SET_KEYS), *NOTE_KEYS))
    shared = _phases(file, content.get("phases"))
    episodes = [(_run_episode if runs else _episode)(file, entry, shared) for entry in listed]
    names = [e.name for e in episodes]
    for name in names:
        if names.count(name) > 1:
            raise GapError(f"{file}: episode '{name}' is listed twice")
    settings = {k: v for k, v in content.items() if k not in ("system", "episodes", "phases")}
    return MeasurementSet(folder=folder, system=system, settings=settings, episodes=_with_roles(file, episodes))


def set_of(
    system: str, fit: Iterable[Any], heldout: Iterable[Any], repeats: Iterable[Any] = (), **settings: Any
) -> MeasurementSet:
    """A measurement set of tables in memory, under the same checks as one of files.

    Args:
        system: built-in one, or the name of the user's own.
        fit: tables parameters are fitted to: anything that gives a column by its name, with `t` [s].
        heldout: tables kept for the comparison.
        repeats: tables of one motion made again, fitted too.
        **settings: what measurement.yaml would say beside (`mass`, `robot`, ...).

    Raises:
        GapError: a table or a setting cannot be used, or one of `fit` and `heldout` is empty.
    """
    file = Path("measurement.yaml")
    _refuse_unknown(file, settings, SET_KEYS)
    settings = {k: v.item() if isinstance(v, np.generic) else v for k, v in settings.items()}
    episodes = []
    for role, tables in (("fit", fit), ("repeat", repeats), ("heldout", heldout)):
        if isinstance(tables, str) or not isinstance(tables, Iterable) or is_table(tables):
            what = "one table" if is_table(tables) else f"{tables!r:.40}"
            raise GapError(f"{role} is {what}, it must be a list of tables")
        for k, table in enumerate(tables, start=1):
            name = f"{role}_{k}"
            episodes.append(Episode(name=name, file=Path(name), role=role, columns=table_of(table, name)))
    _refuse_copies(file, episodes)
    held = [e for e in episodes if e.role == "heldout"]
    if not held or len(held) == len(episodes):
        raise GapError(f"{len(episodes) - len(held)} tables to fit and {len(held)} held out, one of each is needed")
    return MeasurementSet(folder=Path("."), system=system, settings=settings, episodes=tuple(episodes))


def _episode(file: Path, entry: Any, shared: tuple[Phase, ...]) -> Episode:
    if isinstance(entry, str):
        entry = {"file": entry}
    if not isinstance(entry, dict) or not isinstance(entry.get("file"), str):
        raise GapError(f"{file}: every episode needs `file`, this one is {entry!r}")
    _refuse_unknown(file, entry, EPISODE_KEYS, f" of episode {entry['file']}")
    role = _role(file, entry, entry["file"])
    path = file.parent / entry["file"]
    return Episode(
        name=path.stem,
        file=path,
        role=role,
        columns=read_table(path),
        phases=_phases(file, entry.get("phases")) or shared,
        settings={k: v for k, v in entry.items() if k not in ("file", "role", "phases")},
    )


def _run_episode(file: Path, entry: Any, shared: tuple[Phase, ...]) -> Episode:
    """An episode that is a stretch of a recorded run.

    Raises:
        GapError: a key or a value cannot be used, or the record cannot.
    """
    from ...sim.record.recorded_stretch import read_stretch
    from .dressing.loads import columns_of

    if not isinstance(entry, dict) or not isinstance(entry.get("run"), str):
        raise GapError(f"{file}: every episode of system dressing needs `run`, the folder of a record, not {entry!r}")
    name = entry["run"]
    _refuse_unknown(file, entry, RUN_KEYS, f" of episode {name}")
    role, hand = _role(file, entry, name), entry.get("hand")
    if hand not in (None, *SIDES):
        raise GapError(f"{file}: hand of {name} is {hand!r}, it must be one of {', '.join(SIDES)}")
    span: list[float | None] = []
    for key in ("t0", "t1"):
        x = entry.get(key)
        if x is not None and (isinstance(x, bool) or not isinstance(x, int | float) or not 0 <= x < LARGEST):
            raise GapError(f"{file}: {key} of {name} is {str(x)[:SHOWN]}, a time of its clock in seconds is needed")
        span.append(None if x is None else float(x))
    path = file.parent / name
    try:
        stretch = read_stretch(path, span[0], span[1], hand)
    except CaretreeError as error:
        raise GapError(f"{file}: {error}") from None
    at = "" if span[0] is None else f"@{span[0]:g}"
    return Episode(
        name=f"{path.resolve().name}{at}{f'_{hand}' if hand else ''}",
        file=path,
        role=role,
        columns=columns_of(stretch),
        phases=_phases(file, entry.get("phases")) or shared,
        settings={"stretch": stretch},
    )


def _role(file: Path, entry: dict[str, Any], name: str) -> str:
    role = entry.get("role", "")
    if role not in ("", None, *ROLES):
        raise GapError(f"{file}: role of {name} is {role!r}, it must be one of {', '.join(ROLES)}")
    return role or ""


def _refuse_unknown(file: Path, given: dict[Any, Any], known: tuple[str, ...], of: str = "") -> None:
    """Refuse a key that says nothing here: `rolle: heldout` would put held-out data into the fit.

    Raises:
        GapError: there is one; the message names the nearest that there is, and all of them.
    """
    for key in given:
        if key not in known:
            near = difflib.get_close_matches(str(key).lower(), known, n=1, cutoff=ALIKE)
            meant = f"did you mean {near[0]}? " if near else ""
            raise GapError(f"{file}: there is no setting {key!r}{of}, {meant}(there are {', '.join(known)})")


def _phases(file: Path, listed: Any) -> tuple[Phase, ...]:
    if listed is None:
        return ()
    try:
        if isinstance(listed, dict):
            listed = [{"name": k, "t0": v[0], "t1": v[1]} for k, v in listed.items()]
        for p in listed:
            _refuse_unknown(file, dict(p), PHASE_KEYS, " of a phase")
        return tuple(
            Phase(
                name=str(p["name"]),
                t0=float(p.get("t0", p.get("start", 0.0))),
                t1=float(p.get("t1", p.get("end", np.inf))),
            )
            for p in listed
        )
    except (TypeError, KeyError, ValueError, AttributeError, IndexError, OverflowError):
        raise GapError(f"{file}: `phases` must list entries with name, t0 and t1 [s]") from None


def _with_roles(file: Path, episodes: list[Episode]) -> tuple[Episode, ...]:
    """Fill in missing roles: the last third (at least one) is held out unless some episode says so already."""
    if not any(e.role == "heldout" for e in episodes):
        blank = [i for i, e in enumerate(episodes) if e.role == ""]
        if not blank:
            blank = [i for i, e in enumerate(episodes) if e.role == "fit"] or list(range(len(episodes)))
        for i in blank[-max(1, len(blank) // 3) :]:
            episodes[i] = replace(episodes[i], role="heldout")
    episodes = [e if e.role else replace(e, role="fit") for e in episodes]
    if all(e.role == "heldout" for e in episodes):
        raise GapError(f"{file}: every episode is held out, at least one must have role fit")
    _refuse_copies(file, episodes)
    return tuple(episodes)


def _refuse_copies(file: Path, episodes: Sequence[Episode]) -> None:
    """Refuse a recording that is held out and fitted: nothing would be shown on it."""
    for held in (e for e in episodes if e.role == "heldout"):
        for other in (e for e in episodes if e.role != "heldout"):
            if held.columns.keys() == other.columns.keys() and all(
                np.array_equal(x, other.columns[name]) for name, x in held.columns.items()
            ):
                raise GapError(f"{file}: {held.name}, which is held out, is the same recording as {other.name}")


def require_columns(episode: Episode, names: list[str]) -> None:
    """Refuse an episode that lacks a column.

    Raises:
        GapError: names the file, the column and the header row.
    """
    for name in names:
        if name not in episode.columns:
            raise GapError(f"{episode.file}: column '{name}' is missing (row 1 has {', '.join(episode.columns)})")
