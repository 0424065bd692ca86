from dataclasses import dataclass

import pytest
from caretree.sim.quantity import Quantities, quantity
from caretree.sim.scripted.world import ScriptedWorld
from caretree.skills import Context, Input, Key, Output, Scope, Skill
from caretree.skills.core.ports import PortError
from caretree.skills.core.settings import SettingError, Settings
from caretree.trees.guard.guard import GuardedWorld


@dataclass(frozen=True, kw_only=True)
class FetchTuning(Quantities):
    max_load: float = quantity(4.0, "N", "on the hand", "choice: for a test")


class FetchTowel(Skill):
    side = Input(str, doc="which hand")
    towel = Output(float, unit="m", doc="its width")
    tuning = Input(FetchTuning, default=FetchTuning(), doc="its numbers")


class HandTowel(Skill):
    side = Input(str, doc="which hand")
    towel = Input(float, unit="m", doc="its width", default=None)


def context(settings=None):
    guard = GuardedWorld(ScriptedWorld(seed=0))
    return Context(world=guard, guard=guard, settings=settings)


def test_names_begin_with_the_scope_and_ports_wire_themselves():
    arm = Scope(context(), "right arm", keys=("towel",), side="right")
    fetch, hand = FetchTowel("fetch", arm), HandTowel("hand over", arm)
    assert (fetch.name, hand.name) == ("right arm/fetch", "right arm/hand over")
    assert fetch.bindings["towel"] == hand.bindings["towel"] == Key("right_arm_towel")
    assert fetch.side == "right"


def test_what_is_given_wins_and_inner_scopes_know_the_outer_ones():
    outer = Scope(context(), "right arm", keys=("towel",), side="right")
    inner = Scope(outer, "again", side="left")
    hand = HandTowel("hand over", inner, towel=None)
    assert hand.name == "right arm/again/hand over"
    assert (hand.side, hand.towel) == ("left", None)
    assert HandTowel("second", inner).bindings["towel"] == Key("right_arm_towel")


def test_two_scopes_share_no_keys():
    run = context()
    first, second = (Scope(run, f"{side} arm", keys=("towel",)) for side in ("left", "right"))
    assert first["towel"] != second["towel"]


def test_a_constant_is_not_wired_to_an_output():
    fetch = FetchTowel("fetch", Scope(context(), towel=0.5, side="left"))
    assert not isinstance(fetch.bindings["towel"], float)


def test_an_unknown_name_is_told():
    with pytest.raises(PortError, match="it has side, towel"):
        Scope(context(), "right arm", keys=("towel",), side="right")["cup"]
    with pytest.raises(PortError, match="both a key and a constant"):
        Scope(context(), keys=("side",), side="right")


def test_the_run_s_numbers_win_over_the_tree_s():
    run = context(Settings({"fetch_towel": {"max_load": 3.5}}))
    assert FetchTowel("fetch", run, side="left", tuning=FetchTuning(max_load=9.0)).tuning.max_load == 3.5
    run.settings.check()


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"fetch_towl": {"max_load": 3.5}}, "did you mean fetch_towel"),
        ({"cup": {"max_load": 3.5}}, "there are fetch_towel"),
    ],
)
def test_numbers_of_skills_that_are_not_in_the_tree_are_refused(values, words):
    run = context(Settings(values))
    FetchTowel("fetch", run, side="left")
    HandTowel("hand over", run, side="left")
    with pytest.raises(SettingError, match=words):
        run.settings.check()


def test_unknown_numbers_are_refused_when_the_leaf_is_built():
    with pytest.raises(SettingError, match="did you mean max_load"):
        FetchTowel("fetch", context(Settings({"fetch_towel": {"max_lod": 1.0}})), side="left")
