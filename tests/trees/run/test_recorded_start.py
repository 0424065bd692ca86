import json
from argparse import Namespace
from types import SimpleNamespace

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.record.recorded_state import RecordedState
from caretree.trees.run.recorded_start import OF_THE_ROOM, RecordedStart, read_start, take_room


def record(folder, **parameters):
    run = {"task": "dressing", "seed": 107, "world": "bullet", "parameters": {"world_kind": "hard", **parameters}}
    (folder / "run.json").write_text(json.dumps(run))
    return folder


def options(**given):
    return Namespace(**{**OF_THE_ROOM, "world": "bullet", **given})


@pytest.mark.parametrize("text", ["runs/a", "runs/a@", "@3", "runs/a@soon", "runs/a@-1", "runs/a@nan", "runs/a@inf"])
def test_what_is_no_record_and_time_gets_the_form(text):
    with pytest.raises(CaretreeError, match="RECORD@SECONDS, such as"):
        read_start(text)


def test_a_folder_that_is_not_there_is_no_record(tmp_path):
    with pytest.raises(CaretreeError, match="is not a folder with a run record"):
        read_start(f"{tmp_path / 'nowhere'}@3")


def test_the_room_is_the_one_of_the_record(tmp_path):
    given = options()
    take_room(given, record(tmp_path, gown="standard"))
    assert (given.seed, given.gown, given.world_kind, given.person) == (107, "standard", "hard", None)


@pytest.mark.parametrize(
    ("given", "what"),
    [
        ({"seed": 3}, "run with --seed 107, not 3; leave --seed out"),
        ({"person": "small"}, "run with --person None, not small"),
        ({"world": "scripted"}, "was run on 'bullet', not on 'scripted'"),
    ],
)
def test_another_room_than_the_recorded_one_is_refused(tmp_path, given, what):
    with pytest.raises(CaretreeError, match=what):
        take_room(options(**given), record(tmp_path))


def test_a_file_that_is_another_one_by_now_is_refused(tmp_path):
    gown = tmp_path / "gown.yaml"
    gown.write_text("base: medium")
    folder = record(tmp_path, gown=str(gown), file_hashes={"gown": "0123456789abcdef"})
    with pytest.raises(CaretreeError, match=r"the gown file .*gown\.yaml has been changed since .* was recorded"):
        take_room(options(), folder)


def test_a_damaged_record_is_named(tmp_path):
    (tmp_path / "run.json").write_text('{"seed": 1, "world": "bullet"}')
    with pytest.raises(CaretreeError, match="damaged: it has no parameters"):
        take_room(options(), tmp_path)


def test_a_world_with_one_beginning_only_is_told_apart(tmp_path):
    state = RecordedState(t=2.0, vertices=np.zeros((3, 3)), arms=np.zeros((2, 4, 3)), robot=np.zeros(2))
    start = RecordedStart(directory=tmp_path, state=state)
    begun = []
    world = SimpleNamespace(set_recorded_state=begun.append)
    start.prepare(world)
    assert begun == [state]
    assert str(start) == f"{tmp_path}@2.00"
    with pytest.raises(CaretreeError, match="SimpleNamespace cannot"):
        start.prepare(SimpleNamespace())
