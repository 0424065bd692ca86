"""A file of trees with all that it includes: which trees there are, which of them is the task's."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..tasks import task_names
from .document import Element, XmlError, nearest, read_document

FILES_MAX = 100
FORMAT = "4"


@dataclass(frozen=True)
class PythonReference:
    """What a file names as its Python: a task of the package, or a file to be found from the one that names it.

    Attributes:
        name: as it is written.
        file: that names it.
        line: on which.
    """

    name: str
    file: Path
    line: int

    def path(self) -> Path:
        """The file it means, where it is no task of the package.

        Raises:
            XmlError: there is no such file.
        """
        path = self.file.parent / self.name
        if path.suffix != ".py" or not path.is_file():
            raise XmlError(
                f"{self.file}:{self.line}: {self.name!r} is neither a task of the package nor a .py file; "
                f"there are {', '.join(task_names())}"
            )
        return path


class TreeFiles:
    """What one file and its includes hold.

    Args:
        path: of the file.

    Attributes:
        trees: elements <BehaviorTree> by ID.
        models: ports of sub-trees that a <TreeNodesModel> describes: ID -> name -> default; None: it must be given.
        python: what the files name as their Python, the first file's first.
        main: ID of the task's tree.

    Raises:
        XmlError: a file cannot be read, or is no file of trees.
    """

    def __init__(self, path: Path) -> None:
        self.trees: dict[str, Element] = {}
        self.models: dict[str, dict[str, str | None]] = {}
        self.python: list[PythonReference] = []
        self._seen: set[Path] = set()
        self.main = self._main(self._read(path))

    def _read(self, path: Path) -> Element:
        """One file, then those that it includes; one that was read before is not read again, as in a circle."""
        self._seen.add(path.resolve())
        document = read_document(path)
        root = document.root
        if root.attributes.get("BTCPP_format") != FORMAT:
            root.refuse(f'<root> needs BTCPP_format="{FORMAT}": files of another version mean other things')
        self.python += [PythonReference(name, path, line) for name, line in document.python]
        for element in root.children:
            if element.tag == "include":
                self._include(element)
            elif element.tag == "BehaviorTree":
                self._add(element, alone=len(root.below("BehaviorTree")) == 1)
            elif element.tag == "TreeNodesModel":
                self._describe(element)
            else:
                known = ("include", "BehaviorTree", "TreeNodesModel")
                element.refuse(f"<{element.tag}> has no place below <root>; {nearest(element.tag, known)}")
        return root

    def _include(self, element: Element) -> None:
        if "ros_pkg" in element.attributes:
            element.refuse("ros_pkg is not known here; give the path from this file")
        path = element.file.parent / element.needed("path")
        if path.resolve() in self._seen:
            return
        if len(self._seen) >= FILES_MAX:
            element.refuse(f"more than {FILES_MAX} files are included")
        if not path.is_file():
            element.refuse(f"{path} does not exist")
        self._read(path)

    def _add(self, element: Element, alone: bool) -> None:
        name = element.attributes.get("ID") or ("BehaviorTree" if alone else element.needed("ID"))
        if name in self.trees:
            first = self.trees[name]
            element.refuse(f"there is a tree {name!r} already, at {first.file}:{first.line}")
        if len(element.children) != 1:
            element.refuse(f"tree {name!r} has {len(element.children)} nodes at its root, but one is asked for")
        self.trees[name] = element

    def _describe(self, element: Element) -> None:
        for model in element.below("SubTree"):
            ports = [port for port in model.children if port.tag in ("input_port", "output_port", "inout_port")]
            self.models[model.needed("ID")] = {port.needed("name"): port.attributes.get("default") for port in ports}

    def _main(self, root: Element) -> str:
        name = root.attributes.get("main_tree_to_execute", "")
        if name in self.trees:
            return name
        if name:
            root.refuse(f"main_tree_to_execute is {name!r}, but no tree is called so; {nearest(name, self.trees)}")
        if len(self.trees) != 1:
            root.refuse(f"{len(self.trees)} trees are here: say with main_tree_to_execute which one is the task")
        return next(iter(self.trees))
