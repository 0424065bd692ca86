from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.physics import learn_cli
from caretree.learning.physics.clips.clip import Clip
from caretree.learning.physics.clips.frames import frames_of
from caretree.learning.physics.clips.parameters import HIGH, NAMES, SHOWN, to_spec, values_of
from caretree.learning.physics.clips.render_clip import render_clip
from caretree.learning.physics.methods.gp_inversion import fit_gp_inversion
from caretree.learning.physics.methods.method import Examples
from caretree.learning.physics.methods.simulator import Simulator
from caretree.learning.physics.methods.weights import load_weights, save_weights
from caretree.learning.physics.study import identify as identify_module
from caretree.learning.physics.study.identify import identify, write
from caretree.sim.errors import CaretreeError
from caretree.sim.scene.gown import GOWNS
from caretree.sim.scene.gown_file import read_gown
from caretree.trees.cli import main


def make(small_gown, count, seed):
    unit = np.random.default_rng(seed).uniform(0.3, 0.7, (count, 6))
    return Examples(frames=Simulator(small_gown)(unit), unit=unit, class_id=np.full(count, -1), hash=str(seed))


@pytest.fixture(scope="module")
def fitted(small_gown):
    valid = make(small_gown, 24, 1)
    method = fit_gp_inversion(make(small_gown, 60, 0), valid, seed=0, shown=SHOWN)
    some = valid.part(np.arange(12))
    method.sort(False).set_widths("simulated", some.unit, *method.raw(some, lambda _: Simulator(small_gown)))
    return method


@pytest.fixture
def small_cut(monkeypatch, small_gown):
    monkeypatch.setitem(GOWNS, "medium", small_gown)


def test_frames_hold_cover_and_depth():
    depth = np.full((1, 2, 4, 4), np.nan, np.float32)
    depth[0, 1, 0, 0] = 2.9
    frames = frames_of(depth)
    assert frames.shape == (1, 2, 2, 2, 2)
    assert frames[0, 1, 0, 0, 0] == 0.25
    assert frames[0, 1, 1, 0, 0] == pytest.approx(0.25, rel=1e-2)  # 0.3 m behind the usual depth, a quarter of a pixel
    assert frames.sum() == pytest.approx(0.5, rel=1e-2)


def test_weights_come_back_as_they_were_saved(fitted, small_gown, tmp_path):
    path = save_weights(fitted, tmp_path / "w.safetensors", {"data": "abc"})
    again, record = load_weights(path)
    assert record == {"data": "abc"}
    clips = make(small_gown, 3, 7)
    before, after = fitted.infer(clips), again.infer(clips)
    np.testing.assert_allclose(after.unit, before.unit, atol=1e-6)
    np.testing.assert_allclose(after.lower, before.lower, atol=1e-6)
    assert set(again.sort(False).widths) == {"alone", "simulated"}


def test_a_gown_is_identified_from_its_clip(fitted, small_gown, small_cut, tmp_path):
    gown = to_spec(np.full(6, 0.45), small_gown)
    found = identify(render_clip(gown), fitted)
    quick = identify(render_clip(gown), fitted, simulate=False)
    true = values_of(gown)
    shown = list(SHOWN)
    errors = [np.abs(f.values / true - 1)[shown].mean() for f in (found, quick)]
    assert errors[0] < 0.15, errors
    assert errors[0] < errors[1]
    assert (found.lower <= found.values).all()
    assert (found.values <= found.upper).all()
    text = found.table()
    assert all(name in text for name in NAMES)
    assert "not shown" in next(line for line in text.splitlines() if line.startswith("friction"))
    assert "not shown" not in next(line for line in text.splitlines() if line.startswith("mass"))
    gown_file = read_gown(write(found, tmp_path / "gown.yaml"))
    assert gown_file.values["mass"] == pytest.approx(found.values[0])
    assert gown_file.spec.mass == pytest.approx(found.values[0])


def test_a_clip_that_shows_no_falling_gown_is_refused(fitted, small_gown, small_cut):
    clip = render_clip(to_spec(np.full(6, 0.5), small_gown))
    wall = replace(clip, depth=np.full_like(clip.depth, 2.6))
    with pytest.raises(CaretreeError, match="no falling gown of the cut 'medium' looks like this clip"):
        identify(wall, fitted)
    assert (identify(wall, fitted, simulate=False).upper == HIGH).any()  # without a simulation: wide intervals


def test_command_prints_the_table_and_writes_the_gown(fitted, small_gown, small_cut, tmp_path, capsys):
    weights = save_weights(fitted, tmp_path / "w.safetensors", {})
    clip = render_clip(to_spec(np.full(6, 0.5), small_gown)).save(tmp_path / "clip.npz")
    out = tmp_path / "gown.yaml"
    arguments = ["learn", "physics", "identify", str(clip), "--weights", str(weights), "--out", str(out)]
    assert main(arguments) == 0
    assert "90 % interval" in capsys.readouterr().out
    assert set(read_gown(out).intervals) == set(NAMES)


@pytest.mark.parametrize("damage", ["missing", "text", "few", "masked", "rate"])
def test_bad_clips_get_one_sentence_and_exit_2(damage, tmp_path, capsys):
    path = tmp_path / "clip.npz"
    good = {"depth": np.full((15, 64, 64), 2.5, np.float32), "rate": 30.0, "intrinsics": np.array([80, 80, 32, 32.0]),
            "pose_camera_in_map": np.eye(4)}  # fmt: skip
    if damage == "text":
        path.write_text("no clip")
    elif damage != "missing":
        bad = {"few": {"depth": good["depth"][:9]}, "rate": {"rate": 25.0},
               "masked": {"depth": np.full((15, 64, 64), np.nan, np.float32)}}[damage]  # fmt: skip
        np.savez(path, **{**good, **bad})
    assert main(["learn", "physics", "identify", str(path)]) == 2
    message = capsys.readouterr().err.strip()
    assert message.count("\n") == 0
    assert "clip.npz" in message


@pytest.mark.parametrize("out", ["", "none/gown.yaml"])
def test_where_no_gown_can_be_written_is_said_first(fitted, small_gown, out, tmp_path, capsys):
    clip = render_clip(to_spec(np.full(6, 0.5), small_gown)).save(tmp_path / "clip.npz")
    assert main(["learn", "physics", "identify", str(clip), "--out", str(tmp_path / out)]) == 2
    said = capsys.readouterr()
    assert "a gown file cannot be written there" in said.err
    assert not said.out


def test_bad_arguments_get_one_sentence(tmp_path, small_gown, fitted):
    clip = Clip(depth=np.full((15, 64, 64), 2.5, np.float32), rate=30.0, intrinsics=(80.0, 80.0, 32.0, 32.0),
                pose_camera_in_map=np.eye(4))  # fmt: skip
    with pytest.raises(CaretreeError, match=r"unknown gown 'tiny'; there are medium"):
        identify_module.identify(clip, fitted, "tiny")
    with pytest.raises(CaretreeError, match="no list of seeds"):
        learn_cli.parser().parse_args(["train", "data", "--out", "x", "--seeds", "a"])
    with pytest.raises(CaretreeError, match="no such weights"):
        load_weights(tmp_path / "none.safetensors")
    (tmp_path / "w.safetensors").write_text("nonsense")
    with pytest.raises(CaretreeError, match="no file of weights"):
        load_weights(tmp_path / "w.safetensors")
