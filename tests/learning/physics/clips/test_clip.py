import numpy as np
import pytest
from caretree.learning.physics.clips.clip import SIZE, Clip, packed, unpacked
from caretree.learning.physics.engine.fall import FRAMES, RATE
from caretree.sim.errors import CaretreeError


def depth_of(frames=FRAMES, size=SIZE):
    depth = np.full((frames, size, size), np.nan, np.float32)
    depth[:, 10:20, 10:30] = 2.5
    return depth


def clip(**changes):
    return Clip(
        **{
            "depth": depth_of(),
            "rate": RATE,
            "intrinsics": (80.0, 80.0, 31.5, 31.5),
            "pose_camera_in_map": np.eye(4),
            **changes,
        }
    )


def test_what_is_saved_is_loaded(tmp_path):
    mine = clip()
    again = Clip.load(mine.save(tmp_path / "a.npz"))
    np.testing.assert_array_equal(again.depth, mine.depth)
    np.testing.assert_array_equal(again.pose_camera_in_map, mine.pose_camera_in_map)
    assert (again.rate, again.intrinsics, again.depth.dtype) == (mine.rate, mine.intrinsics, np.float32)
    assert [path.name for path in tmp_path.iterdir()] == ["a.npz"]


def gone():
    depth = depth_of()
    depth[3] = np.nan
    return depth


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"depth": depth_of(size=32)}, "15x32x32, it must be 15x64x64"),
        ({"depth": np.zeros((64, 64))}, "64x64, it must be 15x64x64"),
        ({"depth": depth_of(frames=9)}, "has 9 frames, it must have 15"),
        ({"depth": np.full((15, 64, 64), np.nan)}, "every pixel of the clip is masked"),
        ({"depth": gone()}, "frame 3 of the clip is all masked"),
        ({"depth": depth_of() * 1000}, "from 2.5e.03 to 2.5e.03 m, it must lie between 0 and 6.55 m"),
        ({"depth": -depth_of()}, "it must lie between 0"),
        ({"rate": 25.0}, "rate is 25 Hz, it must be 30 Hz"),
        ({"rate": float("nan")}, "rate is nan Hz"),
        ({"intrinsics": (80.0, 80.0, 31.5)}, "intrinsics must be four numbers"),
        ({"intrinsics": (0.0, 80.0, 31.5, 31.5)}, "focal lengths above zero"),
        ({"pose_camera_in_map": np.eye(3)}, "4x4 matrix"),
        ({"pose_camera_in_map": np.zeros((4, 4))}, "must be a rotation and a translation"),
        ({"pose_camera_in_map": np.diag([1.0, 1.0, -1.0, 1.0])}, "must be a rotation and a translation"),
        ({"pose_camera_in_map": np.eye(4)[::-1]}, "must be a rotation and a translation"),
        ({"depth": np.nan_to_num(depth_of())}, "NaN outside the gown"),
    ],
)
def test_a_bad_clip_is_refused_when_made_and_when_read(tmp_path, changes, sentence):
    with pytest.raises(CaretreeError, match=sentence):
        clip(**changes)
    path = tmp_path / "bad.npz"
    good = {"depth": depth_of(), "rate": RATE, "intrinsics": (80.0, 80.0, 31.5, 31.5), "pose_camera_in_map": np.eye(4)}
    np.savez(path, **{**good, **changes})
    with pytest.raises(CaretreeError, match=sentence) as caught:
        Clip.load(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def test_what_is_no_clip_at_all_is_refused(tmp_path):
    with pytest.raises(CaretreeError, match="there is no such clip"):
        Clip.load(tmp_path / "missing.npz")
    (tmp_path / "text.npz").write_text("depth")
    with pytest.raises(CaretreeError, match="this is no clip"):
        Clip.load(tmp_path / "text.npz")
    np.save(tmp_path / "array.npy", np.zeros(3))
    with pytest.raises(CaretreeError, match="this is no clip"):
        Clip.load(tmp_path / "array.npy")
    np.savez(tmp_path / "half.npz", depth=depth_of())
    with pytest.raises(CaretreeError, match="lacks rate, intrinsics, pose_camera_in_map"):
        Clip.load(tmp_path / "half.npz")
    np.savez(tmp_path / "words.npz", depth=depth_of(), rate="fast", intrinsics=np.ones(4), pose_camera_in_map=np.eye(4))
    with pytest.raises(CaretreeError, match="must be numbers"):
        Clip.load(tmp_path / "words.npz")
    np.savez(
        tmp_path / "imaginary.npz",
        depth=depth_of() * 1j,
        rate=RATE,
        intrinsics=np.ones(4),
        pose_camera_in_map=np.eye(4),
    )
    with pytest.raises(CaretreeError, match="must be numbers"):
        Clip.load(tmp_path / "imaginary.npz")
    whole = (tmp_path / "half.npz").read_bytes()
    (tmp_path / "cut.npz").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(CaretreeError, match="this is no clip"):
        Clip.load(tmp_path / "cut.npz")


def test_packing_keeps_the_mask_and_a_twentieth_of_a_millimetre():
    depth = depth_of() + np.random.default_rng(0).normal(0, 0.3, (FRAMES, SIZE, SIZE)).astype(np.float32)
    again = unpacked(packed(depth))
    np.testing.assert_array_equal(np.isnan(again), np.isnan(depth))
    assert np.nanmax(np.abs(again - depth)) < 0.51e-4
