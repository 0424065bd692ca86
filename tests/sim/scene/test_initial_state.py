import pytest
from caretree.sim.scene.initial_state import InitialState
from caretree.sim.world import WorldError


def test_states_are_known_by_their_names():
    assert InitialState.named("gown_worn") is InitialState.GOWN_WORN
    assert InitialState.named("gown_dressed") is InitialState.GOWN_DRESSED
    with pytest.raises(WorldError, match="no run begins with 'C'; there are gown_on_hook, gown_in_hands, gown_on_p"):
        InitialState.named("C")
