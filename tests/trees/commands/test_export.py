from pathlib import Path

import pytest
from caretree.skills.core.skill import Skill
from caretree.trees.cli import main


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.extra
def test_an_exported_task_is_checked_run_and_replayed(capsys):
    assert main(["export", "xml", "wave", "--out", "deep/wave.xml"]) == 0
    assert capsys.readouterr().out == "deep/wave.xml\n"
    assert main(["check", "deep/wave.xml"]) == 0
    assert main(["run", "deep/wave.xml", "--world", "scripted", "--out", "r"]) == 0
    assert main(["run", "deep/wave.xml", "--world", "scripted", "--set", "hold_still.seconds=0.5", "--out", "s"]) == 0
    assert main(["replay", "r"]) == 0
    assert main(["inject", "deep/wave.xml", "--sample", "4"]) == 0


def test_without_out_it_is_printed(capsys):
    assert main(["export", "xml", "wave"]) == 0
    assert '<root BTCPP_format="4" main_tree_to_execute="Task">' in capsys.readouterr().out
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<root/>", 'w.xml:1: <root> needs BTCPP_format="4"'),
        (
            '<root BTCPP_format="4">\n<BehaviorTree><LiftArms/></BehaviorTree></root>',
            "w.xml:2: there is no node",
        ),
        ('<?caretree python="no.py"?><root BTCPP_format="4"><BehaviorTree><HoldStill/></BehaviorTree></root>', "no.py"),
    ],
)
@pytest.mark.parametrize("command", [["check", "w.xml"], ["run", "w.xml", "--world", "scripted"]])
def test_a_mistake_in_a_file_is_one_sentence_and_status_2(text, said, command, capsys):
    Path("w.xml").write_text(text)
    assert main(command) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


def test_senses_that_build_offers_cannot_be_written(capsys):
    before = list(Skill.registry)
    Path("offers.py").write_text("""
from caretree.perception.classical import ClassicalSenses
from caretree.skills import HoldStill

def build(context):
    context.offer_senses(ClassicalSenses(context.world.room, context.rng))
    return HoldStill("h", context)
""")
    assert main(["export", "xml", "offers.py"]) == 2
    assert "return them from a function senses(context)" in capsys.readouterr().err
    Skill.registry[:] = before


def test_an_unknown_form_is_refused(capsys):
    assert main(["export", "svg", "wave"]) == 2
    assert "invalid choice: 'svg'" in capsys.readouterr().err
