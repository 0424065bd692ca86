"""The same side has the same colour everywhere, and what a record lacks is not drawn."""

from __future__ import annotations

import dataclasses

import numpy as np
from caretree.sim.evaluate.series import read_series
from caretree.trees.report.figures import COLOURS, curves, part_style
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
