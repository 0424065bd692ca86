"""A leaf that asks a question and moves nothing."""

from __future__ import annotations

import inspect
import typing
from collections.abc import Callable
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from ...perception.errors import PerceptionFailure
from ...sim.world import EmergencyStop, SensorLost
from ...skills.core.context import Context
from ...skills.core.ports import Key, PortError
from ...skills.core.reasons import Failure, Reason, SkillFailure, reason_of
from .composers import TreeError


def inputs_of(test: Callable[..., object]) -> dict[str, Any]:
    """What a test is given besides the context: name -> declared type, Any where none is declared."""
    try:
        types = typing.get_type_hints(test)
    except (NameError, TypeError):  # types that only a type checker knows, or a callable object
        types = {}
    names = list(inspect.signature(test).parameters)[1:]
    return {name: types.get(name, Any) for name in names}


class Condition(Behaviour):
    """A leaf that asks a question of the context.

    Args:
        name: of the node.
        test: says whether it holds; any truth value, numpy's too.  A SkillFailure carries its own reason.
        reason: why it fails otherwise.
        **given: for the test besides the context: a constant, or a `Key` whose value it gets; `caretree check` proves
            that the key is written.

    Attributes:
        bindings: what is given, by name.

    Raises:
        TreeError: the test does not take what is given, or asks for more; name, test or reason are none.
    """

    def __init__(
        self, name: str, test: Callable[..., object], reason: Reason = Reason.PRECONDITION, **given: Any
    ) -> None:
        if not isinstance(name, str) or not callable(test):
            raise TreeError(f"a Condition takes its name, a text, and then its test, not {name!r} and {test!r}")
        if not isinstance(reason, Reason):
            raise TreeError(f"the reason of {name!r} is a Reason such as Reason.PRECONDITION, not {reason!r}")
        super().__init__(name)
        try:
            inspect.signature(test).bind(None, **given)
        except TypeError as error:
            with_what = ", ".join(("the context", *sorted(given)))
            raise TreeError(f"the test of {name!r} is called with {with_what}: {error}") from None
        self.test = test
        self.reason = reason
        self.bindings = given
        self.failure: Failure | None = None
        self.context: Context | None = None

    def bind(self, context: Context) -> None:
        """Join a run."""
        self.context = context

    def reads(self) -> dict[str, Key]:
        """The keys that the test is given the values of, by name."""
        return {name: bound for name, bound in self.bindings.items() if isinstance(bound, Key)}

    def update(self) -> Status:
        """Ask."""
        self.failure = None
        if self.context is None:
            raise TreeError(f"{self.name!r} is not bound to a run; only the runner ticks a tree")
        try:
            board = self.context.board
            if bool(self.test(self.context, **self.bindings | {n: board.get(k.name) for n, k in self.reads().items()})):
                return Status.SUCCESS
            self.failure = Failure(self.reason, "", self.name)
        except SkillFailure as stop:
            self.failure = Failure(stop.reason, stop.detail, self.name)
        except (SensorLost, EmergencyStop) as stop:
            self.failure = Failure(reason_of(stop), str(stop), self.name)
        except (PortError, PerceptionFailure) as error:
            self.failure = Failure(self.reason, str(error), self.name)
        except Exception as error:
            self.context.report(error)
            self.failure = Failure(Reason.INTERNAL_ERROR, f"{type(error).__name__}: {error}", self.name)
        self.feedback_message = self.failure.sentence()
        return Status.FAILURE
