"""`caretree learn`: parts and commands are named; who may be compared is given to the evaluation."""

import numpy as np
from caretree.learning.vision import cli
from caretree.sim.world import Frame
from caretree.trees.cli import main
from caretree.trees.commands.seers import ClassicalSeer


def test_an_unknown_part_names_those_that_are_there(capsys):
    assert main(["learn", "hearing"]) == 2
    assert "it has physics, vision and pregrasp" in capsys.readouterr().err


def test_seeds_that_are_kept_for_tests_are_refused(capsys, tmp_path):
    assert main(["learn", "vision", "states", str(tmp_path), "--seeds", "8999-9000"]) == 2
    assert "kept for tests" in capsys.readouterr().err.replace("\n", " ")


def test_without_states_the_command_that_makes_them_is_named(capsys, tmp_path):
    assert main(["learn", "vision", "data", str(tmp_path / "d"), "--states", str(tmp_path)]) == 2
    assert "caretree learn vision states" in capsys.readouterr().err


def test_the_evaluation_is_given_both_ways_of_seeing(monkeypatch, tmp_path):
    given = []
    monkeypatch.setattr(cli, "_evaluate", lambda options, seers: given.append(seers(None)))
    assert main(["learn", "vision", "evaluate", str(tmp_path)]) == 0
    assert list(given[0]) == ["learned", "classical"]


def test_another_network_is_told_beside_the_first(monkeypatch, tmp_path):
    told, from_ = [], []
    monkeypatch.setattr("caretree.learning.vision.states.read_states", lambda folder: ([], "s"))
    monkeypatch.setattr(
        "caretree.learning.vision.evaluate.evaluate", lambda states, who, **more: told.append(list(who)) or {}
    )
    monkeypatch.setattr("caretree.learning.vision.table.rows", lambda tallies: [])

    def seers(network):
        from_.append(network)
        return {"learned": None, "classical": None}

    cli.main(["evaluate", str(tmp_path), "--network", "new", "--before", "old"], seers)
    assert told == [["learned", "before", "classical"]]
    assert [path.name for path in from_] == ["new", "old"]


def test_the_classical_way_sees_nothing_in_an_empty_picture():
    pose = np.eye(4)
    pose[2, 3] = 2.0
    grey = np.full((60, 80, 3), 120, np.uint8)
    frame = Frame(
        camera="head",
        stamp=0.0,
        rgb=grey,
        depth=np.full((60, 80), 1.0, np.float32),
        intrinsics=(60.0, 60.0, 39.5, 29.5),
        pose_camera_in_map=pose,
    )
    seer = ClassicalSeer()
    assert not seer.surfaces(frame).any()
    assert seer.corner(frame, "left", np.zeros(3)) is None
    assert seer.strap(frame, "left", np.zeros(3)) is None
    assert seer.arm(frame, "left") is None
