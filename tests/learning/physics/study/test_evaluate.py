import json
from dataclasses import replace

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is an extra: pip install 'caretree[learn]'")
from caretree.learning.physics.clips.parameters import NAMES
from caretree.learning.physics.methods.examples import Loaded
from caretree.learning.physics.methods.weights import load_weights
from caretree.learning.physics.study.evaluate import table, write_results
from caretree.learning.physics.study.registry import TITLES

from ..moving_blobs import blobs


def test_a_study_compares_every_method_on_every_test(study):
    study.run(lambda _: None)
    results = json.loads(write_results(study).read_text())
    rows = {(row["test"], row["method"], row["seed"]): row for row in results["rows"]}
    for test in ("uniform", "heldout_gown"):
        assert {method for t, method, _ in rows if t == test} == set(TITLES) - {"class_centre"}  # there are no classes
        assert {seed for t, method, seed in rows if (t, method) == (test, "paper")} == {0, 1}
    assert rows["uniform", "gp_inversion_simulated", 0]["clips"] == 11
    assert rows["uniform", "paper", 1]["clips"] == 12
    assert set(rows["uniform", "gp_inversion", 0]["coverage"]) == set(NAMES)
    assert results["data"]["hash"] == study.data.examples.hash
    text = table(results)
    assert all(title in text for method, title in TITLES.items() if method != "class_centre")
    assert f"backbone `{study.plan.backbone}`, 3 steps" in text


def test_other_cuts_are_learned_from_and_tested_apart(study, small_gown):
    falls = np.resize(["train", "train", "train", "val", "test"], 100)
    longer = replace(small_gown, length=small_gown.length + 1)
    some = replace(blobs(200, 6, seed=8), rough=np.arange(200) % 2 == 1)
    cuts = Loaded(kind="cuts", gowns=[longer] * 200, examples=some, split=np.repeat(falls, 2))
    wider = replace(study, cuts=cuts, seeds=(0,))
    wider.run(lambda _: None, ("gp_inversion", "supervised"))
    rows = {(row["test"], row["method"]): row for row in json.loads(write_results(wider).read_text())["rows"]}
    assert {test for test, _ in rows} == {"uniform", "cuts", "cuts_rough", "heldout_gown"}
    assert rows["cuts", "gp_inversion"]["clips"] == rows["cuts_rough", "supervised"]["clips"] == 20
    assert rows["cuts", "gp_inversion_simulated"]["clips"] == 11
    _, record = load_weights(wider.folder / "gp_inversion.safetensors")
    assert record["clips"] == 36 + 120
    assert record["processor_seconds"] > 0
    assert set(load_weights(wider.folder / "gp_inversion.safetensors")[0].inversions) == {
        "clean",
        "clean_other",
        "rough_other",
    }
