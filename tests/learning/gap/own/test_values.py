import pytest
import yaml
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.own.values import values_of

from .slider import Slider

ENTRY = {"name": "viscous", "target": "system", "parameters": {"rate": 0.4}}


def model(tmp_path, **changes):
    content = {"format": "caretree-model-1", "system": "slider", "simulator": "slider.py:Slider", "effects": [ENTRY]}
    (tmp_path / "model.yaml").write_text(yaml.safe_dump(content | changes))
    return tmp_path / "model.yaml"


def test_every_parameter_has_a_value_and_what_the_file_does_not_name_is_absent(tmp_path):
    values = values_of(model(tmp_path), Slider())
    assert values == {"rate": 0.4, "force": 0.0, "slope": 0.0, "size": 0.0, "x0": 0.0}


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"system": "base"}, "for system 'base'"),
        ({"effects": [ENTRY | {"name": "drag"}]}, "drag on system is no effect of slider"),
        ({"effects": [ENTRY | {"target": "moon"}]}, "viscous on moon"),
        ({"effects": [ENTRY | {"parameters": {"rate": -1.0}}]}, "rate = -1"),
        ({"effects": [ENTRY | {"parameters": {"speed": 1.0}}]}, "speed = 1"),
    ],
)
def test_what_does_not_fit_is_refused(tmp_path, changes, says):
    with pytest.raises(GapError, match=says):
        values_of(model(tmp_path, **changes), Slider())
