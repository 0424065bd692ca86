"""The report holds what an operator needs and survives a record that lacks it."""

import json
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.evaluate.unharmed_rows import ROWS
from caretree.sim.record.folder_claim import FolderClaim
from caretree.sim.record.record import RunResult
from caretree.sim.record.recorder import Recorder
from caretree.sim.world import Frame
from caretree.trees.cli import main
from caretree.trees.report.looks import LookLog, Witness
from caretree.trees.report.page import FRAMES_MAX, key_moments, write_report
from caretree.trees.report.timeline import Span

from ...gownless import without_gown


class Tags(HTMLParser):
    """Fails on tags that are not closed in order."""

    VOID = ("meta", "img", "br")

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.sources: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.sources += [value or "" for name, value in attrs if name == "src"]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def parsed(page: str) -> Tags:
    tags = Tags()
    tags.feed(page)
    assert not tags.open
    return tags


def test_whole_page(make_record, tmp_path):
    page = write_report(make_record(tmp_path / "run", seed=7, pictures=True)).read_text()
    sources = parsed(page).sources
    assert "The person is dressed." in page
    assert "dressing · seed 7 · world bullet" in page
    assert "sleeve caught on the hand" in page
    assert re.search(r"left armhole up the upper arm</td><td class=n>0\.833", page)
    assert ">unharmed</span>" in page
    assert re.search(r"left wrist above the mattress at the end</td><td class=n>0\.1 m</td><td class=n>≤ 0\.2 m", page)
    assert "-0.1 to 0.08 m" in page
    assert re.search(r"largest force on the torso</td><td class=n>0\.5 N</td><td class=n>≤ 140 N", page)
    assert "physics" in page
    assert "real-time factor" in page
    assert re.search(r"<b>\d+ MB</b><span>peak memory", page)
    assert [source[:14] for source in sources].count("data:image/png") == 1  # curves
    assert page.count("<svg ") == 1  # stages and skills
    assert [source[:15] for source in sources].count("data:image/jpeg") == 5  # start, four stages, the last one the end
    assert "video.mp4" in sources
    assert "Not available" not in page
    assert not re.search(r'(src|href)="(https?:)?//', page)  # nothing is fetched from elsewhere


def test_a_long_stage_is_shown_where_its_skills_end():
    stages = [
        {"name": "A", "t_start": 0.0, "t_end": 20.0},
        {"name": "C", "t_start": 20.0, "t_end": 120.0},
        {"name": "D", "t_start": 120.0, "t_end": 120.2},
        {"name": "E"},
    ]
    spans = [
        Span(path=f"task/C/{name}", t_start=t - 5, t_end=t, status="SUCCESS")
        for name, t in (("look", 30.0), ("lift", 52.0), ("pull", 68.0), ("let go", 119.5))
    ]
    assert key_moments(stages, spans, 0.1, 130.0) == [
        (0.1, "at the start"),
        (20.0, "end of A"),
        (52.0, "lift"),
        (68.0, "pull"),
        (120.0, "end of C"),
        (130.0, "at the end"),
    ]
    assert [caption for _, caption in key_moments(stages[1:2], [], 0.1, 120.0)] == [
        "at the start",
        "within C",
        "within C",
        "within C",
        "end of C",
    ]
    many = [{"name": str(k), "t_start": 50.0 * k, "t_end": 50.0 * (k + 1)} for k in range(20)]
    moments = key_moments(many, [], 0.0, 1000.0)
    assert len(moments) == FRAMES_MAX
    assert moments[-1] == (1000.0, "end of 19")


def test_what_was_asked_of_the_run_is_shown_and_a_task_that_dresses_nobody_is_not_judged(tmp_path):
    recorder = Recorder(
        tmp_path,
        task="mine/wave.py",
        seed=0,
        world="bullet",
        parameters={"stage": "C", "gown": "light", "inject": ["grip_slip@let <go>:start", "occlusion@look:step"]},
    )
    recorder.finish(RunResult(outcome="success", reason="The task is done.", sim_time_s=1.0))
    page = write_report(tmp_path).read_text()
    parsed(page)
    for value, name in (
        ("C", "stage"),
        ("light", "gown"),
        ("grip_slip@let &lt;go&gt;:start", "inject"),
        ("occlusion@look:step", "inject"),
    ):
        assert f"<b>{value}</b><span>{name}</span>" in page
    assert "Not asked of this task" in page
    assert "dressed</span>" not in page


def test_a_task_without_a_gown_shows_its_forces(make_record, tmp_path):
    directory = without_gown(make_record(tmp_path / "run"))
    run = json.loads((directory / "run.json").read_text())
    judgement = {"success": True, "problems": [], "numbers": {}}
    (directory / "run.json").write_text(json.dumps(run | {"task": "wipe_forearm", "judgement": judgement}))
    page = write_report(directory).read_text()
    parsed(page)
    assert "Not available" not in page
    assert 'alt="curves over time"' in page


@pytest.mark.parametrize("truth", [True, False])
def test_a_run_that_was_not_judged_says_what_could_judge_it(make_record, tmp_path, truth):
    directory = make_record(tmp_path / "run", result=None)
    run = json.loads((directory / "run.json").read_text())
    (directory / "run.json").write_text(json.dumps(run | {"task": "wipe_forearm"}))
    if truth:
        assert main(["report", str(directory)]) == 0
    page = write_report(directory).read_text()
    assert "Is the goal reached?" in page
    assert ("asks the task's own judge" in page) == truth
    assert ("holds no truth.npz, by which alone it could be judged" in page) != truth


def test_claim_against_the_geometry_is_shown(make_record, tmp_path):
    directory = make_record(tmp_path / "run")
    run = json.loads((directory / "run.json").read_text())
    (directory / "run.json").write_text(json.dumps(run | {"outcome": "failure", "reason": "It <b>seems</b> off."}))
    page = write_report(directory).read_text()
    parsed(page)
    assert "The tree claimed failure" in page
    assert "It &lt;b&gt;seems&lt;/b&gt; off." in page


def test_a_harmed_person_is_shown_with_the_link_and_the_time(make_record, tmp_path):
    directory = make_record(tmp_path / "run")
    with np.load(directory / "truth.npz") as stored:
        arrays = {name: stored[name] for name in stored.files}
    arrays["robot_capsules"][20, 1] = (0.0, -0.2, 0.12, 0.0, -0.2, 0.13, 0.05)  # 1 cm in the head
    np.savez(directory / "truth.npz", **arrays)
    page = write_report(directory).read_text()
    parsed(page)
    assert ">harmed</span>" in page
    assert ">unharmed</span>" not in page
    assert re.search(r"robot inside head or neck</td><td class=n>0\.01 m</td><td class=n>≤ 0\.002 m", page)
    assert "right palm of the robot in the neck head, 1.6 s" in page


def test_an_old_record_is_drawn_without_harm(make_record, tmp_path):
    directory = make_record(tmp_path / "run")
    with np.load(directory / "truth.npz") as stored:
        arrays = {name: stored[name] for name in stored.files if name not in ROWS}
    np.savez(directory / "truth.npz", **arrays)
    page = write_report(directory).read_text()
    parsed(page)
    assert ">dressed</span>" in page
    assert "harmed" not in page
    assert "Not available" not in page


def test_record_without_truth_or_video(tmp_path):
    recorder = Recorder(tmp_path, task="dressing", seed=0, world="scripted")
    recorder.finish(RunResult(outcome="safe_stop", reason="The operator stopped it.", sim_time_s=1.0))
    page = write_report(tmp_path).read_text()
    parsed(page)
    assert "safe stop" in page
    assert "holds no truth.npz" in page
    assert "Key frames" not in page, "a scripted world has no video, and nobody misses it"
    assert "Forces, hands" not in page


def test_a_bullet_run_without_its_video_says_so(tmp_path):
    recorder = Recorder(tmp_path, task="dressing", seed=0, world="bullet")
    recorder.finish(RunResult(outcome="safe_stop", reason="The operator stopped it.", sim_time_s=1.0))
    assert "No video was recorded" in write_report(tmp_path).read_text()


def test_run_cut_short(make_record, tmp_path):
    directory = make_record(tmp_path / "run")
    run = json.loads((directory / "run.json").read_text())
    (directory / "run.json").write_text(json.dumps({key: run[key] for key in ("task", "seed", "world")}))
    (directory / "truth.npz").write_bytes(b"PK")
    page = write_report(directory).read_text()
    parsed(page)
    assert "cut short" in page
    assert "is damaged" in page


def test_folder_without_run_is_one_sentence(tmp_path):
    with pytest.raises(CaretreeError, match=r"holds no run\.json"):
        write_report(tmp_path)


def test_stage_that_never_ran_is_listed(make_record, tmp_path):
    from caretree.sim.record.record import StageResult

    stages = (
        StageResult(name="A", status="failure", attempts=3, t_start=0.0, t_end=1.0, reason="missed"),
        StageResult(name="B", status="not_run"),
    )
    result = RunResult(outcome="failure", reason="It missed.", stages=stages, sim_time_s=7.28)
    page = write_report(make_record(tmp_path / "run", result=result)).read_text()
    assert "not_run" in page
    parsed(page)


def test_the_page_of_a_killed_run_is_drawn_from_its_spool(tmp_path, make_record, capsys):
    cut = make_record(tmp_path / "cut", result=None)
    claim = FolderClaim(cut)
    assert main(["report", str(cut)]) == 2
    assert "another run is writing" in capsys.readouterr().err
    claim.release()
    assert main(["report", str(cut)]) == 0
    page = (cut / "report.html").read_text()
    assert "The run was cut short" in page
    assert ">dressed</span>" in page
    assert "Not available" not in page
    assert main(["evaluate", str(cut)]) == 0


def test_a_page_can_be_drawn_again(tmp_path, make_record, capsys):
    whole = make_record(tmp_path / "whole")
    assert main(["report", str(whole)]) == 0
    assert "The person is dressed." in (whole / "report.html").read_text()
    run = json.loads((whole / "run.json").read_text())
    (whole / "run.json").write_text(json.dumps(run | {"stages": [{"name": "A", "t_start": "then"}]}))
    assert main(["report", str(whole)]) == 2
    assert "run.json is damaged: could not convert" in capsys.readouterr().err
    assert main(["report", str(tmp_path / "nowhere")]) == 2
    assert "is not a folder with a run record" in capsys.readouterr().err


def test_the_decisive_failure_comes_first_with_what_was_seen(make_record, tmp_path):
    reason = "The camera does not show what was looked for. [right arm/look] no binding"
    result = RunResult(outcome="failure", reason=reason, sim_time_s=7.28)
    directory = make_record(tmp_path / "run", result=result, pictures=True)
    events = [
        {"t": 1.0, "kind": "node", "node": "all", "status": "RUNNING"},
        {"t": 1.0, "kind": "node", "node": "all/right arm/look", "status": "RUNNING"},
    ]
    failed = {"kind": "node", "status": "FAILURE", "reason": "NOTHING_SEEN", "detail": "no <binding>"}
    events += [{"t": 2.0, "node": "all/right arm/look", **failed}, {"t": 3.0, "node": "all/at once", **failed}]
    witness = Witness()
    log = LookLog(directory, witness)
    with (directory / "trace.jsonl").open("w") as trace:
        for event in events:
            if event["t"] == 2.0:
                witness.note("sleeve_opening", picture(1.5), LookupError("what was <looked> for is not there"))
            log.event(event)
            trace.write(json.dumps(event) + "\n")
    page = write_report(directory).read_text()
    parsed(page)
    assert page.index("What went wrong") < page.index("Is the person dressed?")
    assert "<b>right arm/look</b> failed at 2.0 s: The camera does not show what was looked for." in page
    assert "the head camera, and what perception made of it" in page
    assert "what was &lt;looked&gt; for is not there" in page
    assert "the room at that moment" in page
    assert re.search(r"<td>3\.0 s</td>.*at once", page), "failures of the first tick are told too"
    assert "The tree, and what each node came to last (3 nodes)" in page


def picture(t):
    return Frame(
        camera="head",
        stamp=t,
        rgb=np.zeros((30, 40, 3), np.uint8),
        depth=np.ones((30, 40), np.float32),
        intrinsics=(40.0, 40.0, 20.0, 15.0),
        pose_camera_in_map=np.eye(4),
    )


def test_faults_are_on_the_time_axis(make_record, tmp_path):
    directory = make_record(tmp_path / "run")
    plain = write_report(directory).read_text()
    run = json.loads((directory / "run.json").read_text())
    faults = [{"fault": "grip_slip@pull:step", "t": 3.0}, {"fault": "never"}, "nonsense"]
    (directory / "run.json").write_text(json.dumps(run | {"faults": faults}))
    page = write_report(directory).read_text()
    images = [re.findall(r'alt="curves over time" src="(data:image/png[^"]*)', each) for each in (plain, page)]
    assert images[0] != images[1]
    timelines = [
        re.search(r'<svg role="img" aria-label="stages and skills over time".*?</svg>', each).group()
        for each in (plain, page)
    ]
    assert ["grip_slip@pull:step" in each for each in timelines] == [False, True]
