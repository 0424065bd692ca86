"""A record is looked at again, at any time of it."""

from __future__ import annotations

import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.record.record import RunResult
from caretree.sim.record.recorder import Recorder
from caretree.trees.watch.playback import Playback

pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")


@pytest.fixture
def playback(make_record, tmp_path):
    page = Playback(make_record(tmp_path / "run", seed=7))
    yield page
    page.close()


def test_every_time_can_be_shown(playback):
    for t in (0.0, 2.5, playback.end, 1e6):
        playback.show(t)
    assert playback.end == pytest.approx(7.9)


def test_the_slider_shows_another_time(playback, browse):
    page = browse(playback.url)
    page.until(lambda text: "dressing, seed 7: success" in text and "0.0 s" in text)
    playback.slider.value = 4.0
    text = page.until(lambda text: "4.0 s" in text)
    assert "cloth: slow down, 8 N" in text
    assert "go to failure" in text


def test_a_record_without_truth_is_shown_and_one_of_nothing_is_not(tmp_path):
    for name in ("events", "nothing"):
        recorder = Recorder(tmp_path / name, task="dressing", seed=0, world="scripted")
        if name == "events":
            recorder.event({"t": 2.0, "kind": "node", "node": "a/b", "status": "FAILURE", "reason": "TIMEOUT"})
        recorder.finish(RunResult(outcome="failure", reason="It failed.", sim_time_s=2.0))
    page = Playback(tmp_path / "events")
    page.show(2.0)
    page.close()
    with pytest.raises(CaretreeError, match="holds nothing to look at"):
        Playback(tmp_path / "nothing")
