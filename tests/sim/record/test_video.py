"""The video is H.264, keeps the world's pace and refuses odd pictures."""

import signal
import subprocess
import sys

import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.record.video import VideoWriter, read_pictures


def grey(level: int) -> np.ndarray:
    return np.full((48, 64, 3), level, dtype=np.uint8)


def test_pictures_come_back_at_their_time(tmp_path):
    import av

    path = tmp_path / "video.mp4"
    writer = VideoWriter(path, width=64, height=48)
    for t, level in ((5.0, 20), (5.5, 120), (8.0, 220)):  # uneven on purpose
        writer.add(t, grey(level))
    writer.close()
    writer.close()
    assert writer.t_start == 5.0
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        assert stream.codec_context.name == "h264"
        assert stream.codec_context.pix_fmt == "yuv420p"
    levels = [picture.mean() for picture in read_pictures(path, [2.9, 0.0, 0.6, 99.0])]
    np.testing.assert_allclose(levels, [120, 20, 120, 220], atol=4)


def test_wrong_pictures_are_refused(tmp_path):
    with pytest.raises(RecordError, match="even width"):
        VideoWriter(tmp_path / "odd.mp4", width=63, height=48)
    writer = VideoWriter(tmp_path / "video.mp4", width=64, height=48)
    writer.add(1.0, grey(1))
    with pytest.raises(RecordError, match="comes after"):
        writer.add(1.0, grey(2))
    with pytest.raises(RecordError, match="is asked for"):
        writer.add(2.0, np.zeros((48, 64, 3)))
    writer.close()


def test_missing_folder_and_broken_file_are_one_sentence(tmp_path):
    with pytest.raises(RecordError, match="opening"):
        VideoWriter(tmp_path / "nowhere" / "video.mp4", width=64, height=48)
    (tmp_path / "broken.mp4").write_bytes(b"no video")
    with pytest.raises(RecordError, match="not a readable video"):
        read_pictures(tmp_path / "broken.mp4", [0.0])


def test_killed_run_leaves_a_readable_video(tmp_path):
    path = tmp_path / "video.mp4"
    code = f"""
import os, signal, numpy as np
from pathlib import Path
from caretree.sim.record.video import VideoWriter
rng = np.random.default_rng(0)
writer = VideoWriter(Path({str(path)!r}), width=64, height=48)
for k in range(120):
    writer.add(0.1 * k, np.full((48, 64, 3), 2 * k, dtype=np.uint8) + rng.integers(0, 9, (48, 64, 3), dtype=np.uint8))
os.kill(os.getpid(), signal.SIGKILL)
"""
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == -signal.SIGKILL
    early, last = read_pictures(path, [1.0, 99.0])
    assert early.mean() == pytest.approx(24, abs=4)
    assert last.mean() > 100  # well past the first half
