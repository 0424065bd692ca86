"""Which world offers what, asked as the project asks it."""

import pytest
from caretree.sim.abilities import (
    HasKinematics,
    HasTickRate,
    HasTiming,
    SupportsFaults,
    SupportsInitialStates,
    SupportsRecording,
)
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import World
from caretree.skills.scripted.rehearsal import RehearsalWorld

ABILITIES = (HasKinematics, HasTickRate, HasTiming, SupportsFaults, SupportsInitialStates, SupportsRecording)


class Bare(World):
    """The contract and nothing else, as an adapter for a robot may be."""

    def observe(self):
        raise NotImplementedError

    look = send = stop = observe


@pytest.mark.parametrize(
    ("make", "offered"),
    [
        (Bare, set()),
        (ScriptedWorld, {HasKinematics, SupportsFaults}),
        (RehearsalWorld, {HasKinematics, HasTickRate, SupportsFaults, SupportsInitialStates}),
    ],
)
def test_each_world_offers_what_it_has(make, offered):
    world = make()
    assert {ability for ability in ABILITIES if isinstance(world, ability)} == offered
