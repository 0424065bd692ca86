"""Which eyes a run has."""

import pytest
from caretree.perception.learned import relabelled
from caretree.sim.errors import CaretreeError
from caretree.trees.cli import main
from caretree.trees.run.perceptions import PERCEPTIONS, see_with
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task


@pytest.fixture
def context():
    task = load_task("dressing")
    world, senses = task.scripted(0)
    return Run(task, world, seed=0, senses=senses).context


def test_the_rules_look_at_the_picture_itself(context):
    senses = context.senses
    see_with(context, "classical")
    assert context.senses is senses


def test_the_network_is_put_before_the_rules(context, monkeypatch):
    wrapped = []
    monkeypatch.setattr(relabelled, "seen_by_network", lambda senses: wrapped.append(senses) or senses)
    see_with(context, "learned")
    assert wrapped == [context.senses]


def test_what_there_is_not_is_said(context):
    with pytest.raises(CaretreeError, match=r"no perception 'keen'.*classical, learned"):
        see_with(context, "keen")


def test_scripted_senses_have_no_pictures_for_a_network(capsys, tmp_path):
    assert "learned" in PERCEPTIONS
    command = ["run", "dressing", "--world", "scripted", "--perception", "learned", "--out", str(tmp_path / "run")]
    assert main(command) == 2
    assert "scripted senses see none" in capsys.readouterr().err
