"""The same side has the same colour everywhere, and what a record lacks is not drawn."""

from __future__ import annotations

import dataclasses

import numpy as np
from caretree.sim.evaluate.series import read_series
from caretree.trees.report.figures import COLOURS, curves, part_style, telling_skills, timeline
from caretree.trees.report.timeline import Span
from caretree.trees.watch.panel import COLOURS as OF_THE_VIEW


def height_of(png):
    return int.from_bytes(png[20:24], "big")


def test_arms_have_the_colour_of_their_side():
    for side in ("left", "right"):
        assert {part_style(f"{side}_{part}")["color"] for part in ("upper_arm", "forearm", "hand")} == {COLOURS[side]}
    assert part_style("trunk")["color"] not in COLOURS.values()
    assert OF_THE_VIEW == COLOURS


def test_empty_curves_are_left_out(make_record, tmp_path):
    series = read_series(make_record(tmp_path / "run"))
    nobody = np.zeros_like(series.upper_arm)
    bare = dataclasses.replace(series, holds=nobody.astype(bool), upper_arm=nobody, wrists=None, clearance=None)
    assert height_of(curves(bare)) < 0.6 * height_of(curves(series))
    still = dataclasses.replace(
        bare, person_force=0 * series.person_force, speed=nobody, distance=np.full_like(series.distance, np.nan)
    )
    assert curves(still) is None


def test_the_name_of_a_fault_has_room_above_a_short_timeline():
    span = Span(path="task/wait", t_start=0.0, t_end=2.0, status="SUCCESS")
    name = "dead_sensor@wait for the hand of the person:step"
    assert height_of(timeline([], [span], 2.0, [(1.0, name)])) > height_of(timeline([], [span], 2.0))  # or it warns


def test_names_of_thousands_of_letters_leave_room_for_the_timeline():
    name = 5000 * "9"
    span = Span(path=f"task/{name}", t_start=0.0, t_end=2.0, status="FAILURE")
    stage = {"name": name, "status": "failure", "t_start": 0.0, "t_end": 2.0}
    drawn = timeline([stage], [span], 2.0, [(1.0, f"dead_sensor@{name}:step")])  # or it warns
    assert height_of(drawn) <= 1.1 * height_of(timeline([stage], [span], 2.0, [(1.0, 60 * "x")]))


def test_of_too_many_skills_those_are_drawn_that_failed_or_took_longest():
    def span(name, start, seconds, status="SUCCESS"):
        return Span(path=f"task/{name}", t_start=start, t_end=start + seconds, status=status)

    spans = [span("wait", 0.0, 0.1), span("drive", 1.0, 9.0), span("look", 10.0, 0.2), span("take", 11.0, 3.0)]
    spans += [span("look", 14.0, 0.2), span("lay", 15.0, 0.3, "FAILURE")]
    assert telling_skills(spans) == (["wait", "drive", "look", "take", "lay"], 0)
    assert telling_skills(spans, most=3) == (["drive", "take", "lay"], 2)
