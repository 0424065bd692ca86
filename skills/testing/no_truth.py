"""Finds in source code the ways by which what acts could reach a simulation's truth.

What acts knows the world's contract, its own body and its own numbers.  So imports, and what is read of an imported
module, are held to lists of what is known to be harmless; and whatever leads round them is refused wherever it
stands: another object's private attributes, names put together at run time, Python's ways to look into itself, files.

A list like that cannot be proven complete.  Behind a `PipedWorld` there is no truth to be reached in the first place.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Collection, Iterator
from functools import cache
from pathlib import Path

PACKAGES = Path(__file__).resolve().parents[2]  # where `sim`, `skills` and the others lie
MODULES = (  # of caretree, with what is below them
    "learning",
    "perception",
    "sim.abilities",
    "sim.blame",
    "sim.compiled",
    "sim.errors",
    "sim.freshness",
    "sim.mechanics",
    "sim.observation_form",
    "sim.quantity",
    "sim.segments",
    "sim.vector",
    "sim.world",
    "skills",
    "trees.guard",
    "trees.nodes",
    "trees.run.parameters",
    "trees.run.stages",
    "trees.tasks",
)
EXCEPT = ("skills.scripted", "skills.testing")  # they hold a world
REHEARSAL = re.compile(r"trees\.tasks\.\w+\.rehearsal(\..*)?")  # and so does what a task is rehearsed on


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


LIBRARIES = _words("""
    __future__ abc collections contextlib cv2 dataclasses difflib enum filterpy functools heapq itertools math numpy
    pinocchio py_trees re scipy toppra types typing
""")
# Numpy's functions that are called like a module of Python, which many a library would pass on.
FUNCTIONS = _words("array copy random select trace")
FILES = _words("""
    DataSource FileStorage VideoCapture ctypeslib fromfile genfromtxt imread imreadmulti loadtxt memmap npyio
    open_memmap
""")
BUILTINS = _words("""
    __builtins__ __import__ __loader__ __spec__ breakpoint compile delattr dir eval exec getattr globals help input
    locals open vars
""")
DUNDERS = _words("""
    __init__ __init_subclass__ __members__ __mro__ __name__ __new__ __post_init__ __setattr__
""")
INSIDE = _words("""
    ag_frame bit_generator cr_frame ctypes entropy f_back f_builtins f_globals f_locals format format_map gi_frame mro
    seed_seq tb_frame tb_next truth truth_frame truth_static walk_stack walk_tb
""")


def find_leaks(
    source: str,
    *,
    package: str = "",
    libraries: Collection[str] = LIBRARIES,
    modules: Collection[str] = MODULES,
) -> list[str]:
    """What in a file of Python could reach the truth: one sentence each, with its line; none if it is clean.

    Args:
        source: text of the file.
        package: that the file belongs to, for its relative imports, for instance `caretree.skills`.
        libraries: top-level modules that it may import besides caretree, its author's own among them.
        modules: of caretree that it may import, without `caretree.` before them.

    Raises:
        SyntaxError: it is no Python.
    """
    return list(_Scan(ast.parse(source), package, libraries, modules).leaks())


class _Scan:
    def __init__(self, tree: ast.Module, package: str, libraries: Collection[str], modules: Collection[str]) -> None:
        self._nodes = list(ast.walk(tree))
        self._package = package.split(".") if package else []
        self._libraries, self._modules = libraries, modules
        self._imported: dict[str, str] = {}  # name here -> where it comes from, in full
        self._whole: set[str] = set()  # those of them that are modules
        self._own = set(_own_names(self._nodes))
        self._handled: set[int] = set()

    def leaks(self) -> Iterator[str]:
        """All of them, as they stand in the file but for imports, which come first."""
        looks = {
            ast.Import: self._import,
            ast.ImportFrom: self._import_from,
            ast.Call: self._call,
            ast.Attribute: self._attribute,
            ast.MatchClass: self._match,
            ast.Name: self._name,
        }
        for kinds in ((ast.Import, ast.ImportFrom), (ast.Call,), (ast.Attribute, ast.MatchClass, ast.Name)):
            for node in self._nodes:
                if isinstance(node, kinds):
                    for problem in looks[type(node)](node):
                        yield f"line {node.lineno}: {problem}"

    def _import(self, node: ast.Import) -> Iterator[str]:
        for alias in node.names:
            if alias.name.split(".")[0] == "caretree":
                yield f"`import {alias.name}` brings all of caretree along; import with `from`"
            else:
                yield from self._library(alias.name)
            name = alias.asname or alias.name.split(".")[0]
            self._imported[name] = alias.name if alias.asname else name
            self._whole.add(name)

    def _import_from(self, node: ast.ImportFrom) -> Iterator[str]:
        above = self._package[: len(self._package) - node.level + 1] if node.level else []
        module = ".".join([*above, *([node.module] if node.module else [])])
        for alias in node.names:
            name = alias.asname or alias.name
            self._imported[name] = f"{module}.{alias.name}"
            if name == "*":
                yield f"what {module} holds is imported without saying what"
            elif module.split(".")[0] == "caretree":
                self._whole |= {name} if _file(f"{module}.{alias.name}".removeprefix("caretree.")) else set()
                yield from self._of_caretree(module.removeprefix("caretree").strip("."), alias.name)
            else:
                yield from self._library(f"{module}.{alias.name}")

    def _of_caretree(self, module: str, name: str) -> Iterator[str]:
        home = _home(module, name)
        if home is None:
            yield f"{name} is not defined in caretree.{module}, which only imports it"
        elif not _below(home, self._modules) or _below(home, EXCEPT) or REHEARSAL.fullmatch(home):
            yield f"caretree.{home} may know the truth"

    def _library(self, dotted: str) -> Iterator[str]:
        root, *rest = dotted.split(".")
        if root not in self._libraries:
            yield f"{root} is not among the libraries that are known to be harmless"
        for name in rest:
            yield from self._of_library(root, name)

    def _of_library(self, root: str, name: str) -> Iterator[str]:
        if name in FILES or name == "load":
            yield f"{root}'s {name} reads files"
        elif name in sys.stdlib_module_names - FUNCTIONS - set(self._libraries):
            yield f"{root} passes on Python's module {name}"

    def _call(self, node: ast.Call) -> Iterator[str]:
        """`getattr` with a name that is written out is as good as the attribute; with any other it is refused."""
        if isinstance(node.func, ast.Name) and node.func.id == "getattr" and len(node.args) > 1:
            name = node.args[1]
            if isinstance(name, ast.Constant) and isinstance(name.value, str):
                self._handled.add(id(node.func))
                yield from self._read(node.args[0], name.value)

    def _source(self, of: ast.expr) -> str:
        """Where a name, and what is read of it, comes from; empty if it is not imported."""
        if isinstance(of, ast.Attribute):
            source = self._source(of.value)
            return source and f"{source}.{of.attr}"
        return self._imported.get(of.id, "") if isinstance(of, ast.Name) else ""

    def _attribute(self, node: ast.Attribute) -> Iterator[str]:
        if isinstance(node.value, ast.Name) and node.value.id in self._whole:
            self._handled.add(id(node.value))
        return self._read(node.value, node.attr)

    def _read(self, of: ast.expr, name: str) -> Iterator[str]:
        if name.startswith("__"):
            if name not in DUNDERS:
                yield f"{name} looks into Python itself"
        elif name.startswith("_"):
            itself = isinstance(of, ast.Name) and of.id in ("self", "cls")
            parent = isinstance(of, ast.Call) and ast.unparse(of.func) == "super"
            if not parent and not (itself and name in self._own):
                yield f"{ast.unparse(of)}.{name} is private to somebody else"
        elif name in INSIDE:
            yield f".{name} looks inside"
        source = self._source(of)
        if source.startswith("caretree."):
            module = source.removeprefix("caretree.")
            if _file(module):
                yield from self._of_caretree(module, name)
        elif source:
            yield from self._of_library(source, name)
        elif name in FILES:
            yield f".{name} reads files"

    def _match(self, node: ast.MatchClass) -> Iterator[str]:
        for name in node.kwd_attrs:
            yield from self._read(node.cls, name)

    def _name(self, node: ast.Name) -> Iterator[str]:
        if id(node) in self._handled:
            return
        if node.id in BUILTINS:
            yield f"{node.id} reaches what no list can name"
        elif node.id in self._whole:
            yield f"the module {node.id} is handed on whole"


def _own_names(nodes: list[ast.AST]) -> Iterator[str]:
    """Names that a file itself gives to parts of its objects."""
    for node in nodes:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.name
        elif isinstance(node, (ast.Attribute, ast.Name)) and isinstance(node.ctx, ast.Store):
            yield node.attr if isinstance(node, ast.Attribute) else node.id


def _below(module: str, tops: Collection[str]) -> bool:
    return any(f"{module}.".startswith(f"{top}.") for top in tops)


def _file(module: str) -> Path | None:
    path = PACKAGES.joinpath(*module.split("."))
    return next((file for file in (path.with_suffix(".py"), path / "__init__.py") if module and file.is_file()), None)


def _home(module: str, name: str) -> str | None:
    """The module of caretree in which `name` of `module` is defined, itself if it is one; None if only imported."""
    if _file(f"{module}.{name}".strip(".")) or not (file := _file(module)):
        return f"{module}.{name}".strip(".")
    defined, passed_on = _names(file)
    return module if name in defined else f"{module}.{passed_on[name]}" if name in passed_on else None


@cache
def _names(file: Path) -> tuple[frozenset[str], dict[str, str]]:
    """What a module defines, and what a package says (`x as x`) it passes on from which of its own modules."""
    body = ast.parse(file.read_text(encoding="utf-8"))
    nodes = [node for top in body.body for node in (ast.walk(top) if isinstance(top, ast.If) else (top,))]
    stored = [each for node in nodes if isinstance(node, (ast.Assign, ast.AnnAssign)) for each in ast.walk(node)]
    passed_on = {
        alias.name: str(node.module)
        for node in nodes
        if isinstance(node, ast.ImportFrom) and node.level == 1 and file.name == "__init__.py"
        for alias in node.names
        if alias.asname == alias.name
    }
    return frozenset(_own_names([*nodes, *stored])), passed_on
