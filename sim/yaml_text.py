"""YAML as people write it into settings: a key given twice, or text that grows when it is read, is refused."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any

from .extras import later

if TYPE_CHECKING:
    import yaml
else:
    yaml = later("yaml")


EXPONENT = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+$")
PARTS_MAX = 1_000_000  # values of a file once its aliases are written out


def load_yaml(text: str) -> Any:
    """The content of a text.

    Raises:
        yaml.MarkedYAMLError: it is no YAML, gives a key twice, or holds more than settings need.
    """
    try:
        node = yaml.compose(text, Loader=_loader())
        if node is not None:
            _size(node, {})
        return yaml.load(text, Loader=_loader())
    except RecursionError:
        raise yaml.MarkedYAMLError(problem="values lie too deep in each other") from None
    except ValueError as error:  # a date that is none, a number too long for Python
        raise yaml.MarkedYAMLError(problem=str(error).split(" (")[0].split(";")[0]) from None


@cache
def _loader() -> type[yaml.SafeLoader]:
    """The safe loader, to which 1e3 is a number as in YAML 1.2 and everywhere else; YAML 1.1 asks for 1.0e+3."""

    class Loader(yaml.SafeLoader):
        pass

    Loader.add_implicit_resolver("tag:yaml.org,2002:float", EXPONENT, list("-+.0123456789"))
    return Loader


def _size(node: yaml.Node, known: dict[int, int | None]) -> int:
    """How many values a node stands for, each alias written out; `known` has None for those in progress."""
    if id(node) in known:
        size = known[id(node)]
        if size is None:
            raise yaml.MarkedYAMLError(problem="a value contains itself", problem_mark=node.start_mark)
        return size
    known[id(node)] = None
    size = 1
    if isinstance(node, yaml.MappingNode):
        seen = set()
        for key, value in node.value:
            if isinstance(key, yaml.ScalarNode):
                if key.value in seen:
                    raise yaml.MarkedYAMLError(problem=f"{key.value!r} is given twice", problem_mark=key.start_mark)
                seen.add(key.value)
            size += _size(key, known) + _size(value, known)
    elif isinstance(node, yaml.SequenceNode):
        size += sum(_size(item, known) for item in node.value)
    if size > PARTS_MAX:
        raise yaml.MarkedYAMLError(
            problem="its aliases stand for more values than any setting", problem_mark=node.start_mark
        )
    known[id(node)] = size
    return size
