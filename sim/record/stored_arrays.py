"""Arrays by name out of an array file of a record, or one sentence that says why not."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from ..errors import RecordError
from .spool import DAMAGED


def stored_arrays(path: Path, names: Iterable[str], missing: str) -> dict[str, np.ndarray]:
    """The arrays of these names.

    Args:
        path: of the file.
        names: of the arrays.
        missing: follows the sentence that there is no such file.

    Raises:
        RecordError: the file is missing or damaged, or lacks one of them.
    """
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as stored:
            return {name: stored[name] for name in names}
    except FileNotFoundError:
        raise RecordError(f"{path.parent} holds no {path.name}{missing}") from None
    except KeyError as error:
        raise RecordError(f"{path} lacks {str(error).split(' ')[0].strip(chr(34) + chr(39))}") from error
    except DAMAGED as error:
        raise RecordError(f"{path} is damaged and cannot be read: {error}") from error
