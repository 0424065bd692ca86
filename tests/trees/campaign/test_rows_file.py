"""Trials as a table: one row each, the same columns in CSV and Parquet."""

import csv
import sys

import pytest
from caretree.sim.errors import CaretreeError
from caretree.trees.campaign.rows_file import rows_of, write_csv, write_parquet
from caretree.trees.campaign.trial import Trial

TRIALS = {
    "overall": [
        Trial(seed=0, outcome="success", reason="Done.", stages={"lay": "success"}, numbers={"cover": 0.9}),
        Trial(seed=1, outcome="crash", reason='it, "broke"\n', problems=("a", "b")),
    ]
}


def test_every_trial_is_a_row_with_the_same_columns(tmp_path):
    write_csv(tmp_path, TRIALS)
    with (tmp_path / "trials.csv").open(newline="") as file:
        first, second = csv.DictReader(file)
    assert (first["kind"], first["seed"], first["stage lay"], first["cover"]) == ("overall", "0", "success", "0.9")
    assert (second["succeeded"], second["reason"], second["problems"]) == ("False", 'it, "broke"\n', "a; b")
    assert second["cover"] == ""
    assert [list(row) for row in rows_of(TRIALS)] == [list(first)] * 2


def test_an_empty_campaign_has_a_head_and_no_rows(tmp_path):
    write_csv(tmp_path, {})
    assert (tmp_path / "trials.csv").read_text().split() == ["kind,seed,outcome"]


def test_without_pyarrow_one_sentence_says_so(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(CaretreeError, match=r"--parquet needs pyarrow: pip install 'caretree\[parquet\]'"):
        write_parquet(tmp_path, TRIALS)


def test_parquet_holds_the_same_rows(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    assert parquet.read_table(write_parquet(tmp_path, TRIALS)).to_pylist() == rows_of(TRIALS)
