"""Builds the API pages from the docstrings of what authors use: `make docs`, into build/api.

Modules are named one by one: what a page shows is what others may rely on.  A warning of the generator, pdoc, is an
error, and so is a name in `__all__` that leads nowhere.
"""

from __future__ import annotations

import importlib
import sys
import warnings
from pathlib import Path

import pdoc.doc
import pdoc.render

FACES = (
    "caretree.trees",
    "caretree.skills",
    "caretree.trees.guard.limits",
    "caretree.trees.proof.check",
    "caretree.trees.run.runner",
    "caretree.trees.run.task",
    "caretree.skills.core.context",
    "caretree.skills.core.ports",
    "caretree.skills.core.reasons",
    "caretree.skills.core.skill",
    "caretree.skills.scripted.scripted_senses",
    "caretree.perception.senses",
    "caretree.perception.estimates",
    "caretree.sim.abilities",
    "caretree.sim.errors",
    "caretree.sim.evaluate.run_record",
    "caretree.sim.faults",
    "caretree.sim.quantity",
    "caretree.sim.scene.objects",
    "caretree.sim.scripted.world",
    "caretree.sim.world",
)


def face(name: str) -> pdoc.doc.Module:
    """The module of that name with all that it offers, what it imports on first use too.

    Raises:
        ImportError: there is no such module.
        AttributeError: it does not have what its `__all__` names.
    """
    module = importlib.import_module(name)
    for offered in getattr(module, "__all__", ()):
        vars(module)[offered] = getattr(module, offered)
    return pdoc.doc.Module(module)


def build(folder: Path) -> list[Path]:
    """Write a page for each module, an index and what the search needs.

    Args:
        folder: for the pages.

    Returns:
        The pages.

    Raises:
        Warning: the generator has something to say.
    """
    pdoc.render.configure(docformat="google", footer_text="caretree")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        modules = {name: face(name) for name in FACES}
        texts = {f"{name.replace('.', '/')}.html": pdoc.render.html_module(modules[name], modules) for name in FACES}
        texts |= {"index.html": pdoc.render.html_index(modules), "search.js": pdoc.render.search_index(modules)}
    for name, text in texts.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return [folder / name for name in texts]


if __name__ == "__main__":
    out = Path(sys.argv[1])
    print(f"{len(build(out))} files in {out}")
