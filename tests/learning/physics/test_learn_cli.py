import numpy as np
import pytest
from caretree.learning.physics import learn_cli
from caretree.learning.physics.clips.clip import Clip
from caretree.learning.physics.clips.parameters import NAMES, to_spec
from caretree.learning.physics.clips.render_clip import render_clip
from caretree.learning.physics.methods.weights import load_weights, save_weights
from caretree.learning.physics.study import identify as identify_module
from caretree.sim.errors import CaretreeError
from caretree.sim.scene.gown_file import read_gown
from caretree.trees.cli import main


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
