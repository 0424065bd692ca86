"""Files that a run was given, of its gown and of its model: a record says where each is, and what it held."""

from __future__ import annotations

import argparse
import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

OPTIONS = ("gown", "model")
HASHES = "file_hashes"  # among the parameters of a record, by option


def place_files(options: argparse.Namespace) -> None:
    """Give the whole path of each file, so that the record of the run finds it from any folder; names stay as they are.

    Args:
        options: of the command line; changed.
    """
    for name in OPTIONS:
        given = getattr(options, name)
        if given and _is_file(given):
            setattr(options, name, str(Path(given).resolve()))


def hashes_of(given: Mapping[str, Any]) -> dict[str, str]:
    """Option -> hash of its file, of what is given for them."""
    return {name: _hash(given[name]) for name in OPTIONS if isinstance(given.get(name), str) and _is_file(given[name])}


def changed_files(parameters: Mapping[str, Any]) -> str:
    """One sentence where a file is another one than the run of a record was given; else nothing.

    Args:
        parameters: of the record; one of a version that noted no hashes is believed.
    """
    noted, now = parameters.get(HASHES), hashes_of(parameters)
    then = noted if isinstance(noted, Mapping) else {}
    return "; ".join(
        f"the {name} file {parameters.get(name)} {'has been changed' if name in now else 'is gone'} since"
        for name in then
        if now.get(name) != then[name]
    )


def _is_file(text: str) -> bool:
    return bool(Path(text).suffix) and Path(text).is_file()


def _hash(path: str) -> str:
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]
