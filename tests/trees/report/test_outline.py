"""A tree as rows, with what its nodes came to."""

from __future__ import annotations

from caretree.trees.report.outline import (
    Row,
    State,
    outline_from,
    outline_html,
    outline_of,
    read_outline,
    states_at,
    write_outline,
)
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task

from ..held_arm import FILE


def node(t, path, status, **more):
    return {"t": t, "kind": "node", "node": path, "status": status, **more}


EVENTS = [
    node(0.0, "all/look", "RUNNING"),
    node(0.0, "all", "RUNNING"),
    node(1.0, "all/look", "FAILURE", reason="NOTHING_SEEN", detail="no <sleeve>"),
    {"t": 1.0, "kind": "command"},
    node(2.0, "all/arm/pull", "RUNNING"),
    node(3.0, "all/look", "INVALID"),
    node(3.0, "all/arm/pull", "INVALID"),
]


def test_a_tree_is_kept_and_read_again(tmp_path):
    task = load_task(str(FILE))
    world, _ = task.scripted(0)
    run = Run(task, world)
    rows = outline_of(run.root)
    assert next(row.path for row in rows) == run.root.name
    assert sorted(row.path for row in rows) == sorted(run.trace.paths.values())
    write_outline(tmp_path, rows)
    assert read_outline(tmp_path, []) == rows
    (tmp_path / "tree.json").write_text('[{"path": 1}]')
    assert read_outline(tmp_path, EVENTS) == outline_from(EVENTS)


def test_rows_of_a_trace_alone():
    assert [(row.name, row.depth) for row in outline_from(EVENTS)] == [("all", 0), ("arm/pull", 1), ("look", 1)]


def test_states_are_what_nodes_came_to_by_themselves():
    assert states_at(EVENTS, 0.5) == {"all": State("RUNNING"), "all/look": State("RUNNING")}
    last = states_at(EVENTS)
    assert last["all/look"] == State("FAILURE", "NOTHING_SEEN no <sleeve>")
    assert last["all/arm/pull"].status == "INVALID"


def test_a_folded_tree_leaves_out_what_is_below_nodes_at_rest():
    rows = [Row("a", "a", "", 0), Row("a/b", "b", "", 1), Row("a/b/c", "c", "", 2), Row("a/d", "d <e>", "", 1)]
    states = {"a": State("RUNNING"), "a/b": State("SUCCESS"), "a/d": State("FAILURE", "why <not>")}
    whole, folded = (outline_html(rows, states, folded=folded) for folded in (False, True))
    assert "> c</div>" in whole
    assert "> c</div>" not in folded
    assert "> b</div>" in folded
    assert "d &lt;e&gt;" in folded
    assert "why &lt;not&gt;" in folded
