"""One page that tells an operator how a run went: report.html, whole in one file but for the video beside it."""

from __future__ import annotations

import base64
import html
import json
import string
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from ...sim.errors import CaretreeError
from ...sim.evaluate import limits
from ...sim.evaluate.run_record import Judgement
from ...sim.evaluate.series import read_series
from ...sim.evaluate.verdict import Verdict, evaluate
from ...sim.extras import need
from ...sim.record.record import REPORT_FILE, TRACE_FILE, TRUTH_FILE, VIDEO_FILE, is_finished, read_run
from ...sim.record.spool import disk_error
from ...sim.record.video import read_pictures
from ..run.judging import kept
from ..run.task import JUDGED
from . import figures as report_figures
from .bars import timeline
from .looks import Look, drawn, read_looks
from .outline import outline_html, read_outline, states_at
from .timeline import Span, read_trace, spans_of
from .why import Attempt, decisive, failed_attempts, look_at

TEMPLATE = Path(__file__).with_name("report_template.html")
FRAMES_MAX = 12
EVERY, WITHIN = 30.0, 4  # a stage is shown once more for each so many seconds of it, at most so many times [s]
APART = 1.0  # pictures closer together than this are alike [s]
SENTENCES = {"success": "success", "failure": "failure", "safe_stop": "safe stop"}
CLASSES = {"success": "good", "failure": "bad", "safe_stop": "warn"}
Bound = tuple[str, str, float | None, float | None]  # what it is, unit, at least, at most
BOUNDS: dict[str, Bound] = {
    "upper_arm_left": ("left armhole up the upper arm", "", limits.UPPER_ARM_MIN, None),
    "upper_arm_right": ("right armhole up the upper arm", "", limits.UPPER_ARM_MIN, None),
    "coverage": ("torso front covered", "", limits.COVERAGE_MIN, None),
    "outside_out": ("of that, outside out", "", limits.OUTSIDE_MIN, None),
    "gripper_load_max_n": ("largest cloth load", "N", None, limits.LOAD_MAX),
    "stretch_p99": ("edge stretch, 99th percentile", "", None, limits.STRETCH_P99_MAX),
    "stretch_max": ("edge stretch, longest", "", None, limits.STRETCH_MAX),
    "vertex_speed_max_m_per_s": ("fastest vertex", "m/s", None, limits.VERTEX_SPEED_MAX),
    "arm_depth_max_m": ("deepest vertex in an arm", "m", None, limits.DEPTH_MAX),
    "frame_gap_max_s": ("longest gap between frames", "s", None, limits.FRAME_GAP_MAX),
    "gown_travel_m": ("way of the gown", "m", limits.TRAVEL_MIN, None),
}
UNHARMED_BOUNDS: dict[str, Bound] = {  # where the record tells
    "outside_out": ("of that, outside out", "", limits.OUTSIDE_NEAT_MIN, None),
    "robot_depth_head_m": ("robot inside head or neck", "m", None, limits.ROBOT_DEPTH_HEAD_MAX),
    "robot_depth_elsewhere_m": ("robot inside another part", "m", None, limits.ROBOT_DEPTH_MAX),
    "wrist_left_above_bed_m": ("left wrist above the mattress at the end", "m", None, limits.WRIST_ABOVE_BED_MAX),
    "wrist_right_above_bed_m": ("right wrist above the mattress at the end", "m", None, limits.WRIST_ABOVE_BED_MAX),
    "face_covered_s": ("cloth on the face", "s", None, limits.FACE_COVERED_MAX),
    "three_layers": ("torso front under three and more layers", "", None, limits.LAYERS_SHARE_MAX),
    "neckline_along_m": ("middle of the neckline towards the feet", "m", *limits.COLLAR_ALONG),
    "neckline_aside_m": ("middle of the neckline aside", "m", -limits.COLLAR_ASIDE_MAX, limits.COLLAR_ASIDE_MAX),
}


def write_report(directory: Path | str) -> Path:
    """Write report.html into a record, finished or cut short.

    What the record lacks (no truth in a scripted world, no video) is said on the page instead of drawn.

    Returns:
        Path of the page.

    Raises:
        CaretreeError: run.json is missing or damaged, or the page cannot be written.
    """
    directory = Path(directory)
    need("matplotlib", "the report")
    page = build_report(directory)
    path = directory / REPORT_FILE
    part = path.with_name(f"{REPORT_FILE}.part")
    try:
        part.write_text(page, encoding="utf-8", errors="replace")  # names of folders need not be text
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise disk_error(error, f"writing {path}") from error
    return path


def build_report(directory: Path) -> str:
    """The page as HTML; reads the record, writes nothing.

    Raises:
        CaretreeError: run.json is missing or damaged.
    """
    run = read_run(directory)
    outcome = run["outcome"] if is_finished(run) else None
    stages = [stage for stage in run.get("stages") or () if isinstance(stage, Mapping)]
    sentence = run.get("reason") or ("The run ended." if outcome else "The run was cut short before it had an outcome.")
    task, seed, world = (_text(run.get(key)) for key in ("task", "seed", "world"))
    why = _section("What went wrong", _or_sentence(lambda: _why(directory, run, stages)))
    return string.Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        title=f"{task}, seed {seed}",
        outcome=SENTENCES.get(outcome or "", "cut short"),
        outcome_class=CLASSES.get(outcome or "", "warn"),
        subtitle=f"{task} · seed {seed} · world {world}",
        sentence=_text(sentence),
        facts=_facts(run),
        asked="Is the person dressed?" if _dresses(run) and kept(run) is None else "Is the goal reached?",
        verdict=_or_sentence(lambda: _verdict(directory, run)),
        why_failed="" if outcome == "success" else why,
        why=why if outcome == "success" else "",
        stages=_stages(stages),
        timeline=_or_sentence(lambda: _timeline(directory, run, stages)),
        frames=_section("Key frames", _or_sentence(lambda: _frames(directory, run, stages))),
        curves=_section("Forces, hands and cloth", _or_sentence(lambda: _curves(directory, run))),
        tree=_or_sentence(lambda: _tree(directory)),
        timing=_timing(run),
        details=_text(json.dumps({key: run.get(key) for key in ("parameters", "versions", "trace_hash")}, indent=1)),
    )


def _section(title: str, content: str) -> str:
    """A section of the page; none where there is nothing to show."""
    return f"<section><h2>{title}</h2>{content}</section>" if content else ""


def _text(value: object) -> str:
    return html.escape(str(value))


def _or_sentence(build: Callable[[], str]) -> str:
    """What `build` gives, or the one sentence that says why not."""
    try:
        return build()
    except CaretreeError as error:
        return f'<p class="soft">Not available: {_text(error)}.</p>'


def _table(head: Sequence[str], rows: Sequence[Sequence[str]], numeric: Sequence[int] = ()) -> str:
    """HTML table; cells are HTML already, columns in `numeric` are set flush right."""

    def line(cells: Sequence[str], tag: str) -> str:
        return (
            "<tr>"
            + "".join(f"<{tag}{' class=n' if k in numeric else ''}>{cell}</{tag}>" for k, cell in enumerate(cells))
            + "</tr>"
        )

    return "<table>" + line(head, "th") + "".join(line(row, "td") for row in rows) + "</table>"


def _image(data: bytes, alternative: str, kind: str = "png") -> str:
    coded = base64.b64encode(data).decode()
    return f'<img alt="{_text(alternative)}" src="data:image/{kind};base64,{coded}">'


def _seconds(value: Any) -> str:
    return f"{value:.1f} s" if isinstance(value, (int, float)) else "?"


def _facts(run: Mapping[str, Any]) -> str:
    sim, wall = run.get("sim_time_s"), run.get("wall_time_s")
    factor = f"{sim / wall:.2f} x" if isinstance(sim, (int, float)) and isinstance(wall, (int, float)) and wall else "?"
    facts = [(_seconds(sim), "simulated time"), (_seconds(wall), "wall time"), (factor, "real-time factor")]
    if isinstance(run.get("peak_memory_mb"), (int, float)):
        facts.append((f"{run['peak_memory_mb']:.0f} MB", "peak memory"))
    parameters = run.get("parameters") if isinstance(run.get("parameters"), Mapping) else {}
    for key in ("stage", "world_kind", "gown", "person", "look", "engine", "model", "perception", "pregrasp", "inject"):
        given = parameters.get(key) if parameters else None
        facts += [
            (str(value), key.replace("_", " ")) for value in (given if isinstance(given, list) else [given]) if value
        ]
    return "".join(f'<div class="fact"><b>{_text(value)}</b><span>{_text(name)}</span></div>' for value, name in facts)


def _verdict(directory: Path, run: Mapping[str, Any]) -> str:
    """The task's own judge, or the project's evaluator, from the truth alone; other tasks ask nobody."""
    if (judgement := kept(run)) is not None:
        return _own(judgement)
    if _dresses(run):
        return _judged(evaluate(directory))
    if not (directory / TRUTH_FILE).exists():
        says = f"Not asked of this task: the record holds no {TRUTH_FILE}, by which alone it could be judged."
    else:
        says = (
            "Not asked of this task when it ended; <code>caretree evaluate DIR</code> asks the task's own judge, "
            "or, where it has none, whether the person is dressed."
        )
    return f'<p class="soft">{says}</p>'


def _dresses(run: Mapping[str, Any]) -> bool:
    """Whether somebody should be dressed in the end."""
    return Path(str(run.get("task"))).stem in JUDGED


def _own(judgement: Judgement) -> str:
    """What the task's own judge says."""
    kind, word = ("good", "goal reached") if judgement.success else ("bad", "goal not reached")
    says = "Decided by the task's own judge from the recorded truth, whatever the tree says of itself."
    problems = "".join(f"<li>{_text(problem)}</li>" for problem in judgement.problems)
    rows = [(_text(name.replace("_", " ")), f"{value:.3g}") for name, value in judgement.numbers.items()]
    table = _table(("number", "value"), rows, numeric=(1,)) if rows else ""
    badge = f'<p><span class="badge {kind}">{word}</span> <span class="soft">{_text(says)}</span></p>'
    return badge + (f"<ul>{problems}</ul>" if problems else "") + table


def _judged(verdict: Verdict) -> str:
    kind, word = ("good", "dressed") if verdict.dressed else ("bad", "not dressed")
    badges = f'<span class="badge {kind}">{word}</span>'
    if verdict.unharmed is not None:
        kind, word = ("good", "unharmed") if verdict.unharmed else ("bad", "harmed")
        badges += f' <span class="badge {kind}">{word}</span>'
    says = "Decided from the recorded geometry alone, whatever the tree says of itself."
    if not verdict.agrees:
        says += f" The tree claimed {SENTENCES.get(verdict.claimed or '', 'nothing')}."
    problems = "".join(f"<li>{_text(problem)}</li>" for problem in verdict.problems)
    bounds = BOUNDS if verdict.unharmed is None else BOUNDS | UNHARMED_BOUNDS | _force_bounds(verdict)
    rows = []
    for key, (label, unit, low, high) in bounds.items():
        if key in verdict.numbers:
            value = verdict.numbers[key]
            kept = (low is None or value >= low) and (high is None or value <= high)
            rows.append(
                (
                    _text(label),
                    f"{value:.3g} {unit}",
                    f"{_asked(low, high)} {unit}",
                    '<span class="yes">kept</span>' if kept else '<span class="no">broken</span>',
                    f'<span class="soft">{_text(verdict.places.get(key, ""))}</span>',
                )
            )
    table = _table(("number", "value", "bound", "", "where, when"), rows, numeric=(1, 2)) if rows else ""
    head = f'<p>{badges} <span class="soft">{_text(says)}</span></p>'
    return head + (f"<ul>{problems}</ul>" if problems else "") + table


def _asked(low: float | None, high: float | None) -> str:
    """A bound as people write it."""
    if low is not None and high is not None:
        return f"{low:g} to {high:g}"
    return f"≤ {high:g}" if low is None else f"≥ {low:g}"


def _force_bounds(verdict: Verdict) -> dict[str, Bound]:
    """Of the forces on the person, those with a limit."""
    parts = (key.removeprefix("force_").removesuffix("_n") for key in verdict.numbers if key.startswith("force_"))
    limited = {part: limit for part in parts if (limit := limits.force_limit(part)) is not None}
    return {
        f"force_{part}_n": (f"largest force on the {part.replace('_', ' ')}", "N", None, limit)
        for part, limit in limited.items()
    }


def _stages(stages: Sequence[Mapping[str, Any]]) -> str:
    if not stages:
        return '<p class="soft">No stage was recorded.</p>'
    marks = {"success": "yes", "failure": "no"}
    rows = []
    for stage in stages:
        status, start, end = str(stage.get("status")), stage.get("t_start"), stage.get("t_end")
        took = end - start if isinstance(start, (int, float)) and isinstance(end, (int, float)) else None
        rows.append(
            (
                _text(stage.get("name")),
                f'<span class="{marks.get(status, "soft")}">{_text(status)}</span>',
                _text(stage.get("attempts")),
                _seconds(start),
                _seconds(took),
                _text(stage.get("reason") or ""),
            )
        )
    return _table(("stage", "ended as", "attempts", "began", "took", "reason"), rows, numeric=(2, 3, 4))


def _why(directory: Path, run: Mapping[str, Any], stages: Sequence[Mapping[str, Any]]) -> str:
    """The failure that decided, with what was seen, and every other one."""
    attempts = failed_attempts(spans_of(read_trace(directory / TRACE_FILE)), stages)
    looks = read_looks(directory)
    worst = decisive(run, attempts)
    content = "" if worst is None else _decisive(directory, run, worst, look_at(worst, looks))
    if not attempts:
        return content
    rows = [
        (
            ", ".join(f"{t:.1f} s" for t in attempt.times),
            _text(attempt.stage),
            f'<span title="{_text(attempt.span.path)}">{_text(attempt.span.name)}</span>',
            _text(attempt.sentence),
            _text(attempt.span.detail),
        )
        for attempt in attempts
    ]
    said = "What failed on the way, and was recovered from" if worst is None else "Everything that failed"
    return f"{content}<h3>{said}</h3>" + _table(("when", "stage", "skill", "why", "numbers"), rows)


def _decisive(directory: Path, run: Mapping[str, Any], attempt: Attempt, look: Look | None) -> str:
    """The failure that ended the run: where, why, and the last picture before it."""
    span, t = attempt.span, attempt.times[-1]
    words = f"<p><b>{_text(span.name)}</b> failed at {t:.1f} s: {_text(attempt.sentence)} {_text(span.detail)}</p>"
    figures = []
    if look is not None:
        found = "".join(
            f'<li><span class="{"yes" if each.found else "no"}">{_text(each.asked.replace("_", " "))}</span>'
            f" {_text(each.words)}</li>"
            for each in look.findings
        )
        figures.append(
            f"<figure>{_image(report_figures.jpeg(drawn(look)), 'what the camera saw', 'jpeg')}<figcaption>"
            f"the {_text(look.camera.replace('_', ' '))} camera, and what perception made of it<ul>{found}</ul>"
            "</figcaption></figure>"
        )
    start = run.get("video_start_s")
    if (directory / VIDEO_FILE).exists():
        (picture,) = read_pictures(directory / VIDEO_FILE, [max(0.0, t - float(start or 0.0))])
        shown = _image(report_figures.jpeg(picture), "the room at the failure", "jpeg")
        figures.append(f"<figure>{shown}<figcaption>the room at that moment</figcaption></figure>")
    return words + (f'<div class="frames wide">{"".join(figures)}</div>' if figures else "")


def _faults(run: Mapping[str, Any]) -> list[tuple[float, str]]:
    """The faults that were played, when [s] and which."""
    faults = run.get("faults")
    entries = [each for each in faults if isinstance(each, Mapping)] if isinstance(faults, list) else []
    return [(float(each["t"]), str(each.get("fault"))) for each in entries if isinstance(each.get("t"), (int, float))]


def _curves(directory: Path, run: Mapping[str, Any]) -> str:
    """Curves from the truth; a scripted world has none, and nobody misses them."""
    if run.get("world") == "scripted" and not (directory / TRUTH_FILE).exists():
        return ""
    picture = report_figures.curves(read_series(directory), _faults(run))
    return "" if picture is None else _image(picture, "curves over time")


def _tree(directory: Path) -> str:
    """The tree with what each node came to in the end."""
    events = read_trace(directory / TRACE_FILE)
    rows = read_outline(directory, events)
    if not rows:
        return ""
    content = outline_html(rows, states_at(events), folded=False)
    return (
        f"<details><summary>The tree, and what each node came to last ({len(rows)} nodes)</summary>{content}</details>"
    )


def _timeline(directory: Path, run: Mapping[str, Any], stages: Sequence[Mapping[str, Any]]) -> str:
    spans = spans_of(read_trace(directory / TRACE_FILE))
    times = [span.t_end for span in spans]
    times += [t for t, _ in _faults(run)]
    times += [stage["t_end"] for stage in stages if isinstance(stage.get("t_end"), (int, float))]
    if not times:
        return '<p class="soft">Nothing took time.</p>'
    key = " ".join(
        f'<span class="badge" style="background:{report_figures.STATUS[status]}">{label}</span>'
        for status, label in (
            ("success", "success"),
            ("failure", "failure"),
            ("invalid", "stopped"),
            ("running", "cut short"),
        )
    )
    return f"<p>{key}</p>" + timeline(stages, spans, max(times), _faults(run))


def _frames(directory: Path, run: Mapping[str, Any], stages: Sequence[Mapping[str, Any]]) -> str:
    """The first picture, moments of each stage and its end, the last picture, and the video itself."""
    start, end = run.get("video_start_s"), run.get("sim_time_s")
    path = directory / VIDEO_FILE
    if not path.exists():
        return "" if run.get("world") == "scripted" else '<p class="soft">No video was recorded.</p>'
    start = float(start) if isinstance(start, (int, float)) else 0.0
    end = float(end) if isinstance(end, (int, float)) else float("inf")
    moments = key_moments(stages, spans_of(read_trace(directory / TRACE_FILE)), start, end)
    pictures = read_pictures(path, [max(0.0, t - start) for t, _ in moments])
    figures = "".join(
        f"<figure>{_image(report_figures.jpeg(picture), caption, 'jpeg')}<figcaption>{_text(caption)}"
        f"{f', {t:.1f} s' if t < float('inf') else ''}</figcaption></figure>"
        for picture, (t, caption) in zip(pictures, moments, strict=True)
    )
    return (
        f'<div class="frames">{figures}</div><video controls preload="metadata" src="{VIDEO_FILE}"></video>'
        f'<p><a href="{VIDEO_FILE}">{VIDEO_FILE}</a></p>'
    )


def key_moments(
    stages: Sequence[Mapping[str, Any]], spans: Sequence[Span], start: float, end: float
) -> list[tuple[float, str]]:
    """What a reader should see of a run: when [s], and what that is.

    Args:
        stages: of run.json.
        spans: of the skills; a long stage is shown where some of them end.
        start: of the video [s].
        end: of the run [s]; infinite where it is not known.
    """
    moments = [(start, "at the start")]

    def add(t: float, caption: str) -> None:
        if t - moments[-1][0] > APART:  # a stage that found nothing to do shows what the one before it left
            moments.append((t, caption))

    for stage in stages:
        first, last, name = stage.get("t_start"), stage.get("t_end"), stage.get("name")
        if not isinstance(first, (int, float)) or not isinstance(last, (int, float)):
            continue
        count = min(WITHIN, int((last - first) / EVERY))
        for k in range(count):
            wanted = first + (last - first) * (k + 1) / (count + 1)
            ends = [
                (abs(span.t_end - wanted), span.t_end, span.name) for span in spans if first < span.t_end < last - APART
            ]
            add(*(min(ends)[1:] if ends else (wanted, f"within {name}")))
        add(float(last), f"end of {name}")
    add(end, "at the end")
    return moments[: FRAMES_MAX - 1] + moments[-1:] if len(moments) > FRAMES_MAX else moments


def _timing(run: Mapping[str, Any]) -> str:
    wall = run.get("wall_time_s")
    timing = run.get("timing")
    if not isinstance(timing, Mapping) or not timing or not isinstance(wall, (int, float)) or not wall > 0:
        return '<p class="soft">No timers were recorded.</p>'
    parts = sorted(((str(name), float(value)) for name, value in timing.items()), key=lambda part: -part[1])
    rest = wall - sum(value for _, value in parts)
    if rest > 0:
        parts.append(("everything else", rest))
    rows = [
        (
            _text(name),
            f"{value:.1f} s",
            f"{100 * value / wall:.0f} %",
            f'<div class="bar" style="width:{min(100.0, 100 * value / wall):.1f}%"></div>',
        )
        for name, value in parts
    ]
    wide = '<span style="display:block;min-width:380px"></span>'
    return _table(("part", "time", "share", wide), rows, numeric=(1, 2))
