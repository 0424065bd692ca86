"""Each law is broken by a skill made for it, and a good skill passes them all."""

import numpy as np
import pytest
from caretree.sim.world import HandTwist
from caretree.skills import Input, Key, Output, Skill
from caretree.skills.testing import LawBroken, check_skill

UP = np.array((0.0, 0.0, 0.05, 0.0, 0.0, 0.0))  # [m/s]


class Raise(Skill):
    """Raises a hand for a while."""

    seconds = Input(float, unit="s", doc="how long", default=0.5)
    risen = Output(float, unit="m", doc="how far")

    def steps(self):
        end = self.now() + self.seconds
        while self.now() < end:
            self.world.send(HandTwist(side="left", twist_in_map=UP))
            yield
        self.risen = 0.05 * self.seconds


class NeverEnds(Raise):
    def steps(self):
        while True:
            yield


class GoesOn(Raise):
    """Says at once that it stands still."""

    def steps(self):
        self.world.send(HandTwist(side="left", twist_in_map=UP, duration=60.0))
        yield from self.wait(3.0)

    def cancel(self):
        return True


class HidesErrors(Raise):
    def update(self):
        status = super().update()
        if self.failure is not None:
            self.failure = None
        return status


class KeepsOutput(Raise):
    def start(self):
        super().start()
        self.risen = 1.0

    def reset_outputs(self):
        pass


class ForgetsTheLease(Raise):
    def initialise(self):
        super().initialise()
        self.context.world.send(HandTwist(side="left", twist_in_map=UP))


class HasADefect(Raise):
    def steps(self):
        yield
        raise KeyError("towel")


def make(kind):
    return lambda context: kind("it", context, risen=Key("risen"))


def test_a_good_skill_passes():
    check_skill(make(Raise))


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        (NeverEnds, "does not end"),
        (GoesOn, "still moved|went on"),
        (HidesErrors, "ended it with None"),
        (KeepsOutput, "output risen of the first round"),
        (ForgetsTheLease, "commanded without the lease"),
        (HasADefect, "raised an error.*towel"),
    ],
)
def test_a_law_that_is_broken_is_named(kind, words):
    with pytest.raises(LawBroken, match=f"(?s){kind.__name__} 'it'.*({words})"):
        check_skill(make(kind))
