import numpy as np
import pytest
import yaml
from caretree.learning.gap.bench.joint_case import arm_motions, inverse_dynamics
from caretree.learning.gap.joints.payloads.carried import Carried
from caretree.learning.gap.joints.rigid import During
from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study
from caretree.sim.effects.model_file import load_model, save_model

RATE = 50.0  # [Hz]
NOISE = 0.3  # [N m]
ALWAYS = (-np.inf, np.inf)


def arm_set(folder, courses):
    """A UR5 that carries `courses`: per recording, (from when [s], mass [kg]); the last is held out."""
    rng = np.random.default_rng(4)
    t = np.arange(0.0, 16.0, 1.0 / RATE)
    motions, names, (pin, model) = arm_motions(rng, "ur5", t, len(courses))
    last, entries = model.njoints - 1, []
    for k, (motion, course) in enumerate(zip(motions, courses, strict=True)):
        load = inverse_dynamics(pin, model, motion)
        for (start, mass), stop in zip(course, [*(x for x, _ in course[1:]), np.inf], strict=True):
            heavy = model.copy()
            heavy.inertias[last] += pin.Inertia(mass, np.array([0.0, 0.02, 0.08]), np.zeros((3, 3)))
            rows = (t >= start) & (t < stop)
            load[rows] = inverse_dynamics(pin, heavy, motion)[rows]
        load += NOISE * rng.normal(size=load.shape)
        n = len(names)
        header = ["t", *(f"q{j + 1}" for j in range(n)), *(f"dq{j + 1}" for j in range(n))]
        header += [f"tau{j + 1}" for j in range(n)]
        data = np.column_stack([t, motion[0], motion[1], load])
        np.savetxt(folder / f"r{k}.csv", data, delimiter=",", header=",".join(header), comments="")
        entries.append({"file": f"r{k}.csv", "role": "heldout" if k == len(courses) - 1 else "fit"})
    (folder / "measurement.yaml").write_text(yaml.safe_dump({"system": "arm", "robot": "ur5", "episodes": entries}))
    return open_study(load_set(folder))


def test_a_payload_taken_up_half_way_is_told_with_its_time_and_on_held_out_recordings_too(tmp_path):
    study = arm_set(tmp_path, [[(0.0, 0.0), (7.3, 2.0)], [(0.0, 2.0), (5.1, 0.0)]])
    verdict = study.conclude()
    assert verdict.verdict == "effects"
    assert [(f.name, f.target) for f in verdict.effects] == [("payload", "wrist_3_joint")]
    mass = verdict.effects[0].parameters[0]
    assert mass.low < mass.value < mass.high
    assert mass.value == pytest.approx(2.0, abs=0.05)
    first, second = verdict.changes
    assert (first.episode, second.episode) == ("r0", "r1")
    assert (first.t, second.t) == (pytest.approx(7.3, abs=0.2), pytest.approx(5.1, abs=0.2))
    assert (first.before, first.after, second.after) == (0.0, pytest.approx(2.0, abs=0.05), 0.0)
    assert [w[0] for w in verdict.effects[0].when] == ["r0", "r1"]
    assert verdict.gap.closed > 0.9
    save_model(tmp_path / "model.yaml", study.patch())
    held = load_model(tmp_path / "model.yaml").effects  # at the end of the fitted recording it is carried
    assert [e.parameters["mass"] for e in held] == [pytest.approx(2.0, abs=0.05)]


def test_a_payload_that_stays_is_one(tmp_path):
    verdict = arm_set(tmp_path, [[(0.0, 2.0)], [(0.0, 2.0)]]).conclude()
    assert [f.name for f in verdict.effects] == ["payload"]
    assert verdict.changes == ()
    assert verdict.effects[0].when == ()


def test_what_a_mass_on_a_rail_takes_up_half_way_is_told_beside_friction_and_is_in_its_model(axis_set, tmp_path):
    later = np.arange(800) >= 330  # rows of 10 ms
    study = open_study(load_set(axis_set(lambda q, v, a: 4.0 * a * later + 2.0 * np.sign(v), noise=0.05)))
    verdict = study.conclude()
    assert verdict.verdict == "effects"
    assert {f.name for f in verdict.effects} == {"coulomb_friction", "payload"}
    payload = next(f for f in verdict.effects if f.name == "payload")
    (mass,) = payload.parameters
    assert payload.equivalent == ("armature", "gain_error")
    assert mass.value == pytest.approx(4.0, abs=0.1)
    told = [(c.episode, round(c.t, 1), round(c.after)) for c in verdict.changes]
    assert told == [("e0", 3.3, 4), ("e1", 3.3, 4), ("e2", 3.3, 4)]
    save_model(tmp_path / "model.yaml", study.patch())
    held = load_model(tmp_path / "model.yaml").effects
    assert [e.parameters["mass"] for e in held if e.name == "payload"] == [mass.value]


def test_a_payload_exchanged_after_the_fitted_recording_is_said_and_not_added(tmp_path):
    study = arm_set(tmp_path, [[(0.0, 1.0)], [(0.0, 1.0), (8.0, 3.0)]])
    verdict = study.conclude()
    assert verdict.verdict == "unknown"
    assert [(c.episode, c.t) for c in verdict.changes] == [("r1", pytest.approx(8.0, abs=0.2))]
    assert (verdict.changes[0].before, verdict.changes[0].after) == (
        pytest.approx(1.0, abs=0.1),
        pytest.approx(3.0, abs=0.1),
    )
    assert "payload is not the same all the time" in verdict.guess
    assert all(e["parameters"]["mass"] < 2.0 for e in study.patch()["effects"])


def test_two_payloads_made_one_are_carried_through():
    a = During(spells={"r": ((-np.inf, 3.0), (5.0, np.inf)), "s": (ALWAYS,)}, last=False)
    b = During(spells={"r": ((3.0, 5.0),), "s": ()}, last=True)
    found = Carried(during=(a, b), price=10.0)
    assert found.cost == 20.0  # taken up and put down; from one recording to the next nothing changes
    one = found.joined(0, 1)
    assert [d.spells for d in one.during] == [{"r": (ALWAYS,), "s": (ALWAYS,)}]
    assert one.during[0].last
    assert one.cost == 0.0


def test_what_acts_for_a_while_is_told_of_recordings_by_name():
    part = During(spells={"r": ((1.0, 2.0),)}, last=True)
    t = np.array([0.5, 1.0, 1.5, 2.0])
    assert part.acts("r", t).tolist() == [False, True, True, False]
    assert part.acts("r~", t).tolist() == [False, True, True, False]
    assert part.acts("another", t).all()
