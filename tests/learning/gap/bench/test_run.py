import json
from concurrent.futures import Future

from caretree.learning.gap.bench import run


class Here:
    """The process that knows what is hidden, without a process."""

    def submit(self, do, *given):
        done = Future()
        done.set_result(do(*given))
        return done


def test_a_drag_with_the_cube_passes_for_wind_until_the_drops_asked_for_are_made(tmp_path, monkeypatch):
    monkeypatch.setattr(run, "_apart", Here)
    first, second = (json.loads(f.read_text()) for f in run.solve("fall", 412, tmp_path, again=True))
    assert first["hidden"] == [["cubic_drag", "body"]]
    assert first["verdict"] == "effects"
    assert second["verdict"] == "unknown"
    assert run.solve("fall", 412, tmp_path, again=True)[1].read_text() == json.dumps(second)
