"""What the success table counts."""

from caretree.trees.campaign.trial import Trial
from caretree.trees.campaign.trials_table import rates, table, whole_runs


def trial(seed, outcome, dressed=None, unharmed=None, **stages):
    return Trial(seed=seed, outcome=outcome, reason="", stages=stages, dressed=dressed, unharmed=unharmed)


def counts(*trials):
    found = whole_runs({"overall": list(trials)})
    assert {rate.trials for rate in found.values()} == {len(trials)}
    return {name: rate.successes for name, rate in found.items()}


def test_trials_that_never_reach_a_stage_do_not_count_for_it():
    trials = [Trial(seed=0, outcome="failure", reason="", stages={"A": "failure", "B": "not_run"})]
    assert (rates({"overall": trials})["overall"]["B"].trials, str(rates({})["overall"]["overall"])) == (0, "-")


def test_a_stage_counts_alone_and_within_whole_runs():
    rows = rates(
        {
            "overall": [trial(0, "success", lay="success"), trial(1, "failure", lay="failure")],
            "stage-lay": [trial(n, "success", lay="success") for n in range(3)],
        }
    )
    assert (rows["independent"]["lay"].successes, rows["independent"]["lay"].trials) == (3, 3)
    assert (rows["overall"]["lay"].successes, rows["overall"]["lay"].trials) == (1, 2)
    assert (rows["overall"]["overall"].successes, rows["overall"]["overall"].trials) == (1, 2)


def test_trials_of_several_stages_count_for_none_of_them_alone():
    rows = rates({"stage-lay-spread": [trial(0, "success", lay="success", spread="success")]})
    assert rows["independent"]["lay"].trials == 0


def test_the_geometry_decides_over_the_tree_and_the_disagreement_is_told():
    found = {"overall": [trial(5, "success", dressed=False), trial(6, "success", dressed=True)]}
    whole = rates(found)["overall"]["overall"]
    assert (whole.successes, whole.trials) == (1, 2)
    assert "disagree on seeds 5." in table(found)


def test_dressed_unharmed_and_claimed_are_counted_apart():
    found = [
        trial(0, "success", dressed=True, unharmed=True),
        trial(1, "success", dressed=False, unharmed=False),
        trial(2, "failure", dressed=False, unharmed=True),
        trial(3, "crash"),
        trial(4, "failure", dressed=True, unharmed=True),
    ]
    assert counts(*found) == {"dressed and unharmed": 2, "unharmed": 3, "claimed": 2, "wrongly claimed": 1}
    text = table({"overall": found})
    assert "  unharmed: 3/5 = 60%" in text
    assert "seed 1 not dressed, HARMED (tree: success)" in text
    assert found[0].sentence().startswith("seed 0 dressed, unharmed")


def test_rows_of_which_no_run_tells_are_left_out():
    assert counts(trial(0, "success", dressed=True)) == {"dressed": 1, "claimed": 1, "wrongly claimed": 0}
    assert counts(trial(0, "success"), trial(1, "failure")) == {"claimed": 1}
