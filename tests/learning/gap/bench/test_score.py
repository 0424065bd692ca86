import pytest
from caretree.learning.gap.bench.score import holds, interval, judge_case, side_by_side, table


def case(hidden, said, kind="single", verdict="effects", equivalent=()):
    truth = {
        "system": "axis",
        "seed": 1,
        "kind": kind,
        "intervals": [],
        "effects": [{"name": n, "target": "axis", "size": 3.0} for n in hidden],
    }
    return judge_case(
        truth,
        {
            "verdict": verdict,
            "where": [],
            "gap": {"closed": 0.9},
            "effects": [{"name": n, "target": "axis", "equivalent": list(equivalent), "parameters": []} for n in said],
        },
    )


def two(name):
    return {"name": name, "target": "body", "size": 3.0, "parameters": []}


def test_exact_set_counts_neither_more_nor_less():
    assert case(["offset"], ["offset"])["exact"]
    assert not case(["offset"], ["offset", "spring"])["exact"]
    assert not case(["offset"], [])["exact"]
    assert not case(["offset"], ["offset"], verdict="unknown")["exact"]


def test_stated_equivalents_count_apart():
    row = case(["asymmetric_friction"], ["coulomb_friction"], equivalent=["asymmetric_friction"])
    assert not row["exact"]
    assert row["up_to_equivalents"]


def test_exact_and_told_as_equal_are_counted_together():
    equal = case(["asymmetric_friction"], ["coulomb_friction"], equivalent=["asymmetric_friction"])
    asked = {r[0]: r[2:4] for r in table([equal, case(["offset"], ["offset"]), case(["offset"], ["spring"])])}
    assert asked["single effect, exact or told as equal"] == (2, 3)
    assert asked["wrong set named, the truth among its equals"] == (1, 2)


def test_a_set_listed_beside_the_one_named_counts_apart():
    truth = {"system": "fall", "seed": 1, "kind": "two", "intervals": [], "effects": [two("wind"), two("delay")]}
    said = {
        "verdict": "effects",
        "where": [],
        "gap": {"closed": 0.9},
        "effects": [two("linear_drag")],
        "rivals": [{"effects": [["delay", "body"], ["wind", "body"]], "experiment": ""}],
    }
    assert judge_case(truth, said)["together"]
    assert not judge_case(truth, said)["exact"]
    assert not judge_case(truth, {**said, "rivals": []})["together"]
    assert not judge_case(truth, {**said, "verdict": "unknown"})["together"]


def test_anything_said_where_nothing_is_hidden_is_a_false_alarm():
    assert case([], ["offset"], kind="none")["false_alarm"]
    assert case([], [], kind="none", verdict="unknown")["false_alarm"]
    assert not case([], [], kind="none", verdict="adequate")["false_alarm"]


def test_interval_is_exact():
    low, high = interval(0, 20)
    assert low == 0.0
    assert high == pytest.approx(1 - 0.025 ** (1 / 20))


def test_table_has_a_row_per_question():
    rows = table([case(["offset"], ["offset"]), case([], [], kind="none", verdict="adequate")])
    assert any(r[0].startswith("single effect, size >= 2") and r[2:4] == (1, 1) for r in rows)


def test_two_rounds_stand_side_by_side():
    lines = side_by_side([[case(["offset"], [])], [case(["offset"], ["offset"])]])
    row = next(line for line in lines if line.startswith("single effect, size >= 2, exact set"))
    assert row.index("0/   1") < row.index("1/   1")


def test_a_stated_interval_holds_the_truth_or_not_or_is_doubted():
    stated = {"name": "value", "value": 1.0, "low": 0.8, "high": 1.2}
    truth = {
        "system": "axis",
        "seed": 1,
        "kind": "single",
        "intervals": [],
        "effects": [{"name": "offset", "target": "axis", "size": 3.0, "values": {"value": 1.1}}],
    }
    said = {"verdict": "effects", "where": [], "gap": {"closed": 0.9}}
    rows = [
        judge_case(truth, {**said, "effects": [{"name": "offset", "target": "axis", "parameters": [p]}]})
        for p in (stated, {**stated, "high": 1.05}, {**stated, "high": None}, {**stated, "doubt": "at its bound"})
    ]
    assert [holds(i) for r in rows for i in r["intervals"]] == [True, False, True, True]
    asked = {r[0]: r[2:4] for r in table(rows)}
    assert asked["95 % interval holds the truth"] == (2, 3)
    assert asked["number whose interval is said not to hold"] == (1, 4)
