import pytest
from caretree.learning.gap.notebook import run
from caretree.learning.gap.own.equals import equals, separating

from .recorded import example, tables
from .slider import Slider, pushes


def study(system, tables):
    *fit, held = tables
    return run(system, fit=fit, heldout=[held]).study


def test_an_equal_far_from_linear_is_found_by_simulation():
    # 9 % lost in turning is a track 3 cm wider: the columns at the solution part, the simulations do not
    s = study(example("base"), tables(example("base"), {"d_left": -0.0005, "turn_lost": 0.086}, count=4, seed=122))
    names = [e.name for e in s.found.effects]
    k = next(i for i, name in enumerate(names) if name in ("track_width", "turning_slip"))
    other = equals(s.sim, s.found, k)
    assert {names[k], *other[0].names} == {"track_width", "turning_slip"}
    assert separating(s.sim, s.found, other[0], s.outcome.floor)[1] < 0.1


class Leaning(Slider):
    """A slider whose tilt can be told from wind where the command is turned round, as the wind then turns too."""

    name = "leaning"

    def predict(self, log, values):
        turned = 1.0 if log["push"][:10].sum() > 0.0 else -1.0
        return super().predict(log, {**values, "force": turned * values["force"]})


def test_the_recording_that_tells_is_the_one_in_which_they_part():
    both = [log for log in pushes(12, kind=Leaning, hidden={"force": 0.2}) if log["push"][:10].sum() > 0.0][:3]
    s = study(Leaning(), both)
    (found,) = s.found.effects
    (other,) = equals(s.sim, s.found, 0)
    assert {found.name, *other.names} == {"wind", "tilt"}
    sentence, apart = separating(s.sim, s.found, other, s.outcome.floor)
    assert sentence == "repeat it with the commands turned round"
    assert apart > 5.0


@pytest.mark.parametrize("hidden", [{"rate": 0.4}, {"size": 0.05}])
def test_an_effect_with_a_trace_of_its_own_has_no_equal(hidden):
    s = study(Slider(), pushes(hidden=hidden))
    assert equals(s.sim, s.found, 0) == []
