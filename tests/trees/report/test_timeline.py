"""Spans of work read back from a trace."""

import json

import pytest
from caretree.sim.errors import CaretreeError
from caretree.trees.report.timeline import Span, read_trace, spans_of


def event(t: float, node: str, status: str, **more: object) -> dict[str, object]:
    return {"t": t, "kind": "node", "node": node, "status": status, **more}


def test_leaves_that_take_time_or_fail_at_once_become_spans():
    spans = spans_of(
        [
            event(0.0, "root", "RUNNING"),
            event(0.0, "root/A", "RUNNING"),
            event(0.0, "root/A/look", "SUCCESS"),
            event(0.0, "root/A/pull", "RUNNING"),
            {"t": 0.5, "kind": "command", "what": "twist"},
            event(2.0, "root/A/pull", "FAILURE", reason="SLEEVE_CAUGHT", detail="at the elbow"),
            event(2.0, "root/A/asks", "FAILURE"),
            event(2.0, "root/A/right arm/lift", "FAILURE", reason="NOTHING_SEEN"),
            event(2.0, "root/A/pull#2", "RUNNING"),
            event(3.0, "root/A/pull#2", "INVALID"),
            event(3.0, "root/B", "RUNNING"),
            {"t": 5.0, "kind": "end"},
        ]
    )
    assert spans == [
        Span(
            path="root/A/pull",
            t_start=0.0,
            t_end=2.0,
            status="FAILURE",
            reason="SLEEVE_CAUGHT",
            detail="at the elbow",
            label="pull",
        ),
        Span(
            path="root/A/right arm/lift",
            t_start=2.0,
            t_end=2.0,
            status="FAILURE",
            reason="NOTHING_SEEN",
            label="right arm/lift",
        ),
        Span(path="root/A/pull#2", t_start=2.0, t_end=3.0, status="INVALID", label="pull"),
        Span(path="root/B", t_start=3.0, t_end=5.0, status="RUNNING", label="B"),
    ]
    assert [span.name for span in spans] == ["pull", "right arm/lift", "pull", "B"]


def test_trace_cut_short_is_read_up_to_the_cut(tmp_path):
    path = tmp_path / "trace.jsonl"
    path.write_text(json.dumps(event(0.0, "a", "RUNNING")) + "\n" + '{"t": 1.0, "ki')
    assert len(read_trace(path)) == 1
    path.write_text(path.read_text() + "\n")  # no kill writes the end of a line that it cut short
    with pytest.raises(CaretreeError, match=r"trace\.jsonl:2 is damaged"):
        read_trace(path)


@pytest.mark.parametrize("text", ['{"t": \n{"t": 1}\n', "[]\n"])
def test_damaged_trace_is_one_sentence_with_its_line(tmp_path, text):
    path = tmp_path / "trace.jsonl"
    path.write_text(text)
    with pytest.raises(CaretreeError, match=r"trace\.jsonl:1 "):
        read_trace(path)
    with pytest.raises(CaretreeError, match="cannot be read"):
        read_trace(tmp_path / "nowhere")
