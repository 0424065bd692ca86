"""XML files as elements that know their line; whatever could grow or reach outside (a DTD, an entity) is refused."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NoReturn
from xml.parsers import expat

from ...sim.errors import CaretreeError

SIZE_MAX = 4_000_000  # bytes of one file
DEPTH_MAX = 200  # elements inside each other; BehaviorTree.CPP ends at 256
PYTHON = re.compile(r'\s*python="([^"]+)"\s*')
SHOWN = 12  # names that an error lists whole


class XmlError(CaretreeError):
    """A tree in XML that cannot be read; begins with `file:line`."""


@dataclass
class Element:
    """One element.

    Attributes:
        tag: its name.
        attributes: by name, in the order of the file.
        file: that it stands in.
        line: of its beginning.
        children: elements right below.
    """

    tag: str
    attributes: dict[str, str]
    file: Path
    line: int
    children: list[Element] = field(default_factory=list)

    def refuse(self, text: str) -> NoReturn:
        """Say what is wrong here.

        Raises:
            XmlError: always.
        """
        raise XmlError(f"{self.file}:{self.line}: {text}")

    def needed(self, name: str) -> str:
        """The attribute `name`.

        Raises:
            XmlError: there is none, or it is empty.
        """
        if not self.attributes.get(name):
            self.refuse(f"<{self.tag}> needs the attribute {name}")
        return self.attributes[name]

    def below(self, tag: str) -> list[Element]:
        """The children of that tag."""
        return [child for child in self.children if child.tag == tag]


@dataclass(frozen=True)
class Document:
    """One file.

    Attributes:
        root: its element <root>.
        python: what each `<?caretree python="..."?>` names, the task or file whose Python its nodes are, with its line.
    """

    root: Element
    python: list[tuple[str, int]]


def nearest(name: str, known: Iterable[str]) -> str:
    """What could have been meant: the most alike, else all of a few names."""
    names = sorted(known)
    if near := difflib.get_close_matches(name, names, n=1):
        return f"did you mean {near[0]}?"
    shown = names if len(names) <= SHOWN else difflib.get_close_matches(name, names, n=5, cutoff=0.0)
    return f"there are {', '.join(shown)}" if len(names) <= SHOWN else f"among others there are {', '.join(shown)}"


def read_document(path: Path) -> Document:
    """The file at `path`.

    Raises:
        XmlError: it cannot be read, is no XML, or holds more than trees need.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise XmlError(f"{path}: {error.strerror or error}") from error
    if len(data) > SIZE_MAX:
        raise XmlError(f"{path}:1: {len(data)} bytes are no tree; at most {SIZE_MAX} are read")
    return _Reading(path).document(data)


class _Reading:
    """One file while it is parsed."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._open: list[Element] = []
        self._root: Element | None = None
        self._python: list[tuple[str, int]] = []
        self._parser: Any = expat.ParserCreate()
        self._parser.StartElementHandler = self._begin
        self._parser.EndElementHandler = self._end
        self._parser.StartDoctypeDeclHandler = self._doctype
        self._parser.ProcessingInstructionHandler = self._instruction

    def document(self, data: bytes) -> Document:
        try:
            self._parser.Parse(data, True)
        except expat.ExpatError as error:
            raise XmlError(f"{self._path}:{error.lineno}: {expat.ErrorString(error.code)}") from None
        except (LookupError, ValueError) as error:  # an encoding that Python does not have, or cannot give to expat
            raise XmlError(f"{self._path}:{self._parser.CurrentLineNumber}: {error}") from None
        if self._root is None or self._root.tag != "root":
            found = self._root.tag if self._root else "nothing"
            raise XmlError(f'{self._path}:1: a file of trees is one <root BTCPP_format="4">, but this is <{found}>')
        return Document(self._root, self._python)

    def _begin(self, tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, attributes, self._path, self._parser.CurrentLineNumber)
        if len(self._open) >= DEPTH_MAX:
            element.refuse(f"<{tag}> is element {DEPTH_MAX + 1} inside another; at most {DEPTH_MAX} are read")
        if self._open:
            self._open[-1].children.append(element)
        self._root = self._root or element
        self._open.append(element)

    def _end(self, tag: str) -> None:
        self._open.pop()

    def _doctype(self, *_: object) -> None:
        raise XmlError(f"{self._path}:{self._parser.CurrentLineNumber}: a tree has no <!DOCTYPE>, nor entities")

    def _instruction(self, target: str, text: str) -> None:
        if target != "caretree":
            return
        found = PYTHON.fullmatch(text)
        if found is None:
            line = self._parser.CurrentLineNumber
            raise XmlError(f'{self._path}:{line}: <?caretree {text}?> is not written <?caretree python="..."?>')
        self._python.append((found.group(1), self._parser.CurrentLineNumber))
