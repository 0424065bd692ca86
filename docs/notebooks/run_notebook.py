"""Runs a notebook cell by cell, as Jupyter does but without it: `python docs/notebooks/run_notebook.py FILE...`.

It writes what the cells print and show back into the file.  Tests run the notebooks the same way.  Only plain Python is
understood, no magics; cells run in a folder of their own, so that no path of this machine comes into their output.
"""

from __future__ import annotations

import ast
import base64
import contextlib
import io
import json
import os
import sys
import tempfile
import traceback
from pathlib import Path
from typing import Any

os.environ.setdefault("MPLBACKEND", "agg")


class CellError(Exception):
    """A cell has failed; says which one, and its traceback."""


def executed(notebook: dict[str, Any], folder: Path) -> dict[str, Any]:
    """The notebook with the outputs that its cells have now.

    Args:
        notebook: format 4.
        folder: that its cells work in.

    Raises:
        CellError: a cell raises.
    """
    names: dict[str, Any] = {"__name__": "__main__"}
    cells, count = [], 0
    with contextlib.chdir(folder):
        for cell in notebook["cells"]:
            if cell["cell_type"] == "code":
                count += 1
                cell = cell | {"execution_count": count, "outputs": _outputs("".join(cell["source"]), names, count)}
            cells.append(cell)
    return notebook | {"cells": cells}


def _outputs(source: str, names: dict[str, Any], count: int) -> list[dict[str, Any]]:
    code = ast.parse(source, f"cell {count}")
    last = code.body.pop() if code.body and isinstance(code.body[-1], ast.Expr) else None
    printed, value = io.StringIO(), None
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            exec(compile(code, f"cell {count}", "exec"), names)  # running the cells is the point
            if last is not None:
                value = eval(compile(ast.Expression(last.value), f"cell {count}", "eval"), names)
    except Exception:
        raise CellError(f"cell {count}:\n{source}\n{printed.getvalue()}\n{traceback.format_exc()}") from None
    outputs: list[dict[str, Any]] = []
    if printed.getvalue():
        outputs.append({"name": "stdout", "output_type": "stream", "text": _lines(printed.getvalue())})
    if value is not None:
        outputs.append(_shown(value, count))
    return outputs


def _shown(value: Any, count: int) -> dict[str, Any]:
    """A figure as a picture, anything else as text."""
    if hasattr(value, "savefig"):
        picture = io.BytesIO()
        value.savefig(picture, format="png", dpi=70, metadata={"Software": None})
        data: dict[str, Any] = {"image/png": base64.b64encode(picture.getvalue()).decode()}
        return {"data": data, "metadata": {}, "output_type": "display_data"}
    data = {"text/plain": _lines(repr(value))}
    return {"data": data, "execution_count": count, "metadata": {}, "output_type": "execute_result"}


def _lines(text: str) -> list[str]:
    return text.splitlines(keepends=True)


def main(files: list[str]) -> None:
    """Run notebooks and keep what they show."""
    for file in files:
        path = Path(file).resolve()
        with tempfile.TemporaryDirectory() as folder:
            notebook = executed(json.loads(path.read_text(encoding="utf-8")), Path(folder))
        path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
