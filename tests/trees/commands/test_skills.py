import pytest
from caretree.skills.core.ports import ports_of
from caretree.trees.cli import main
from caretree.trees.run.catalogue import all_skills


def test_the_list_names_every_leaf(capsys):
    assert main(["skills"]) == 0
    shown = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert shown == sorted(shown)
    assert {"navigate", "lift_arm", "pull_along_arm", "spread"} <= set(shown)


@pytest.mark.parametrize("name", ["lift_arm", "LiftArm"])
def test_one_skill_is_described_by_either_name(name, capsys):
    assert main(["skills", name]) == 0
    out = capsys.readouterr().out
    for word in ("Inputs:", "hand", "Outputs:", "hold", "ARM_SLIPPED", "The person's arm slipped out of the grip."):
        assert word in out


def test_an_unknown_name_gets_the_nearest(capsys):
    assert main(["skills", "lift_arms"]) == 2
    assert "did you mean lift_arm?" in capsys.readouterr().err


@pytest.mark.parametrize("kind", all_skills().values(), ids=lambda kind: kind.__name__)
def test_every_port_says_what_it_is(kind):
    assert all(port.doc for _, port in ports_of(kind)), [name for name, port in ports_of(kind) if not port.doc]
