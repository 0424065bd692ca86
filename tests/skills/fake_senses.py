"""Senses that know what a test tells them and nothing else."""

from dataclasses import replace

from caretree.perception.errors import PerceptionFailure, Problem
from caretree.perception.estimates import Shift
from caretree.perception.senses import Senses

RESTS = {  # unless a test says so, nobody moves, and their chest does not show
    "arm_shift": Shift(stamp=0.0, confidence=0.9, share=0.0),
    "chest_front": PerceptionFailure(Problem.OUT_OF_REACH, "chest of the person"),
}


def fake_senses(**answers):
    """Senses whose methods answer from a script; asked for anything else, they fail the test.

    Args:
        answers: by the name of the method: an estimate, an exception to raise, a function `(frame, **details)` that
            gives one of these, or a list of them, one for each call, the last for ever after.
    """
    unknown = set(answers) - Senses.__abstractmethods__
    assert not unknown, f"there are no such senses: {unknown}"
    methods = {name: _method(name, answers) for name in Senses.__abstractmethods__}
    return type(Senses)("FakeSenses", (Senses,), methods)()


def _method(name, answers):
    script = (RESTS | answers).get(name, AssertionError(f"the test says nothing of {name}"))
    rest = list(script) if isinstance(script, list) else [script]

    def estimate(self, frames, **details):
        answer = rest.pop(0) if len(rest) > 1 else rest[0]
        if callable(answer):
            answer = answer(frames, **details)
        if isinstance(answer, BaseException):
            raise answer
        return replace(answer, stamp=(frames[-1] if isinstance(frames, tuple) else frames).stamp)

    return estimate
