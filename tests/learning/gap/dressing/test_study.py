"""The workflow on records of lifts, with a world in the place of the physics whose loads are written by hand."""

from dataclasses import replace

import numpy as np
import pytest
import yaml
from caretree.learning.gap.dressing import study as studied
from caretree.learning.gap.dressing.loads import SEEN_LOW, Predictions
from caretree.learning.gap.errors import GapError
from caretree.learning.gap.measurement import load_set, set_of
from caretree.learning.gap.open_study import open_study
from caretree.sim.effects.model_file import load_model, save_model
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.record.recorded_stretch import read_stretch
from caretree.sim.robot.baxter import BAXTER
from scipy.spatial.transform import Rotation

from ....sim.record.recorded_lift import write_record
from ....sim.record.test_measured import ARMS

LENGTH, ARM = 0.28, 0.9  # [m], [kg]
WRIST = np.array((0.3, -0.1, 0.7))  # it stays where it is [m]
FACING = kinematics_of(BAXTER).pose_camera_in_map("head", np.array((1.0, 0.0, np.pi)), np.zeros((2, 7)), 0.0)[:3, :3]


def load_of(t, values, quirk, drag=0.0):
    """(T, 3) load of an arm that is swung up and down again: weight, friction, damping and a spring."""
    rate = np.cos(2 * np.pi * (t - t[0]) / 8.0)
    angle = np.sin(2 * np.pi * (t - t[0]) / 8.0)
    mass = ARM + values.get("mass", 0.0)
    turn = (2.0 + values.get("torque", 0.0)) * np.tanh(8 * rate)
    turn += (4.0 + values.get("damping", 0.0)) * 0.3 * rate + values.get("stiffness", 0.0) * angle
    across = -turn / LENGTH * (1.0 + 0.1 * mass)  # not quite straight in all of it
    up = -0.6 * mass * 9.81 * np.cos(0.6 * angle)
    aside = quirk * np.sin(5 * t) + 2000.0 * np.clip(drag, -0.002, 0.002)
    return np.column_stack((0.3 * across, aside, up + across * np.cos(0.6 * angle)))


class HandWritten(Predictions):
    """A world without physics."""

    def _found(self, stretch, effects, drag, key):
        self.simulated += 1
        values = {name: x for e in effects for name, x in e.parameters.items()}
        return np.hstack((load_of(stretch.robot.t, values, 0.0, drag), WRIST * np.ones((len(stretch.robot.t), 3))))


@pytest.fixture(scope="module")
def lift(tmp_path_factory):
    return read_stretch(write_record(tmp_path_factory.mktemp("lift"), ARMS))


def measured(lift, values, bias=(0.0, 0.0, 0.0), quirk=0.0, drags=(0.0, 0.0, 0.0, 0.0), camera=(0.0, 0.0, 0.0)):
    """Four recordings of 16 s, as a set of system dressing."""
    from caretree.learning.gap.dressing.loads import columns_of

    episodes = []
    for k in range(4):
        rng, t = np.random.default_rng([100, k]), 5.0 + np.arange(240) / 15.0
        turn = Rotation.from_euler("xyz", np.column_stack((0.6 * np.sin(t), 0.3 * np.cos(t + k), 0.0 * t)))
        wrench = np.zeros((len(t), 2, 6))
        wrench[:, 0, :3] = load_of(t, values, quirk, drags[k]) + turn.apply(bias) + 0.1 * rng.normal(size=(len(t), 3))
        pose = np.zeros((len(t), 2, 7))
        pose[:, :, 3:] = turn.as_quat()[:, None]
        seen = np.tile(lift.robot.arm_points[:1], (len(t), 1, 1))
        seen[:, 2] = WRIST - (0.0, 0.0, SEEN_LOW) - FACING @ camera + 0.002 * rng.normal(size=(len(t), 3))
        robot = replace(
            lift.robot,
            t=t,
            wrench_hand=wrench,
            pose_hand=pose,
            arm_positions=np.tile(lift.robot.arm_positions[:1], (len(t), 1, 1)),
            head_pan=np.zeros(len(t)),
            pose_base=np.tile((1.0, 0.0, np.pi), (len(t), 1)),
            arm_t=t,
            arm_side=np.ones(len(t), int),
            arm_points=seen,
        )
        held = replace(lift.held, part=np.full((len(t), 2), (4, -1)), cloth=np.zeros((len(t), 2), bool))
        stretch = replace(lift, robot=robot, held=held, looked_at=np.ones(len(t), bool))
        episodes.append(columns_of(stretch) | {"stretch": stretch})
    tables = [{k: v for k, v in e.items() if k != "stretch"} for e in episodes]
    made = set_of("dressing", tables[:3], tables[3:])
    given = (replace(e, settings={"stretch": x["stretch"]}) for e, x in zip(made.episodes, episodes, strict=True))
    return replace(made, episodes=tuple(given))


@pytest.fixture(autouse=True)
def without_physics(monkeypatch):
    monkeypatch.setattr(studied, "Predictions", HandWritten)


def test_nothing_hidden_is_adequate(lift):
    v = open_study(measured(lift, {})).conclude()
    assert v.verdict == "adequate"
    assert v.effects == ()


@pytest.mark.parametrize(
    ("values", "name", "parameter", "size"),
    [
        ({"mass": 0.3}, "arm_weight", "mass", 0.3),
        ({"torque": 0.9}, "joint_friction", "torque", 0.9),
        ({"torque": -0.7}, "joint_friction", "torque", -0.7),
        ({"stiffness": 3.0}, "joint_stiffness", "stiffness", 3.0),
    ],
)
def test_what_is_hidden_in_the_arm_is_named_and_goes_into_the_model_file(lift, tmp_path, values, name, parameter, size):
    study = open_study(measured(lift, values))
    v = study.conclude()
    assert [f.name for f in v.effects] == [name]
    found = v.effects[0].parameters[0]
    assert found.value == pytest.approx(size, rel=0.05)
    assert found.low < size < found.high
    assert v.gap.after < 0.5 * v.gap.before
    save_model(tmp_path / "model.yaml", study.patch())
    (entry,) = load_model(tmp_path / "model.yaml").effects
    assert entry.parameters[parameter] == pytest.approx(found.value)


def test_the_world_is_simulated_again_where_the_answer_is(lift):
    study = open_study(measured(lift, {"mass": 0.4}))
    assert study.conclude().verdict == "effects"
    assert study.system.centre["mass"] == pytest.approx(0.4, abs=0.02)


class Bent(HandWritten):
    """A world in which a spring half as stiff as usual pushes one recording's hand aside, and no other one does."""

    def _found(self, stretch, effects, drag, key):
        found = super()._found(stretch, effects, drag, key)
        stiffness = sum(e.parameters.get("stiffness", 0.0) for e in effects)
        found[:, 1] += 4.0 * (stretch.person == "bent") * max(0.0, 1.0 - abs(stiffness - 1.0))
        return found


def test_held_out_recordings_have_their_say_where_the_world_was_simulated(lift, monkeypatch):
    monkeypatch.setattr(studied, "Predictions", Bent)
    given = measured(lift, {"stiffness": 2.2})
    last = given.episodes[-1]
    bent = replace(last, settings={"stretch": replace(last.settings["stretch"], person="bent")})
    v = open_study(replace(given, episodes=(*given.episodes[:-1], bent))).conclude()
    assert [f.name for f in v.effects] == ["joint_stiffness"]


def test_a_load_cells_bias_is_told_hand_by_hand_and_costs_no_simulation_of_its_own(lift, tmp_path):
    study = open_study(measured(lift, {}, bias=(0.8, -1.0, 1.2)))
    v = study.conclude()
    assert [(f.name, f.target) for f in v.effects] == [("load_cell_bias", "left_hand")]
    assert [p.value for p in v.effects[0].parameters] == pytest.approx((0.8, -1.0, 1.2), abs=0.1)
    save_model(tmp_path / "model.yaml", study.patch())
    assert set(load_model(tmp_path / "model.yaml").effects[0].parameters) == {"fx", "fy", "fz"}


def test_what_the_fingers_drag_is_each_recordings_own_and_no_finding(lift):
    study = open_study(measured(lift, {"mass": 0.3}, drags=(0.0015, -0.0008, 0.0, -0.0015)))
    v = study.conclude()
    assert [f.name for f in v.effects] == ["arm_weight"]
    assert v.gap.channels["fy"]["before"] < 1.0, "of its floor"
    own = [study.sim.own(r, study.found.point.values)["grip_drag"] for r in study.sim.recordings]
    assert own == pytest.approx((0.0015, -0.0008, 0.0), abs=1e-4)


def test_loads_that_are_told_late_are_named(lift):
    lifted = measured(lift, {})
    late = [
        replace(e, columns={**e.columns, **{c: np.interp(e.t - 0.3, e.t, e.columns[c]) for c in ("fx", "fy", "fz")}})
        for e in lifted.episodes
    ]
    v = open_study(replace(lifted, episodes=tuple(late))).conclude()
    assert [f.name for f in v.effects] == ["load_delay"]
    assert v.effects[0].parameters[0].value == pytest.approx(0.3, abs=0.03)


def test_a_camera_that_sits_elsewhere_is_told_along_its_own_axes(lift):
    v = open_study(measured(lift, {}, camera=(0.02, -0.01, 0.015))).conclude()
    assert [(f.name, f.target) for f in v.effects] == [("camera_offset", "head_camera")]
    assert [p.value for p in v.effects[0].parameters] == pytest.approx((0.02, -0.01, 0.015), abs=2e-3)


def test_a_tracker_that_slips_for_a_second_is_no_burst(lift):
    def seen_low(episode, k):
        low = 0.11 * ((episode.t > episode.t[8]) & (episode.t < episode.t[8] + 1.3)) * (k == 0)
        return replace(episode, columns={**episode.columns, "wz": episode.columns["wz"] - low})

    for bias in ((0.0, 0.0, 0.0), (0.8, -1.0, 1.2)):
        given = measured(lift, {}, bias=bias)
        slipped = replace(given, episodes=tuple(seen_low(e, k) for k, e in enumerate(given.episodes)))
        assert open_study(slipped).conclude().verdict == ("effects" if any(bias) else "adequate")


def test_an_effect_on_loads_alone_is_borne_out_however_well_the_arm_is_seen(lift):
    """Beside three channels that nothing changes, a friction closed 11 % of what counted, and was given up."""
    v = open_study(measured(lift, {"torque": -1.2}, drags=(0.0, 0.0, 0.0, 0.0015))).conclude()
    assert [f.name for f in v.effects] == ["joint_friction"]


def test_what_no_effect_makes_is_unknown(lift):
    assert open_study(measured(lift, {}, quirk=1.5)).conclude().verdict == "unknown"


def test_tables_in_place_of_records_are_refused():
    t = np.arange(40) / 10.0
    with pytest.raises(GapError, match="takes records of runs, given as `run: FOLDER`"):
        open_study(set_of("dressing", [{"t": t, "fx": t}], [{"t": t, "fx": -t}]))


def test_a_set_of_records_is_read_strictly(tmp_path):
    write_record(tmp_path / "a", ARMS)
    write_record(tmp_path / "b", ARMS + (0.0, 0.0, 0.01))

    def asked(*episodes, **more):
        content = {"system": "dressing", "episodes": list(episodes), **more}
        (tmp_path / "measurement.yaml").write_text(yaml.safe_dump(content))
        return load_set(tmp_path)

    plain = asked({"run": "a", "role": "fit"}, {"run": "b", "role": "heldout"})
    assert [(e.name, e.role) for e in plain.episodes] == [("a", "fit"), ("b", "heldout")]
    assert set(plain.episodes[0].columns) >= {"t", "hand", "fx", "fy", "fz"}
    for episode, told in (
        ({"run": "b", "rolle": "heldout"}, "no setting 'rolle' of episode b, did you mean role"),
        ({"file": "b"}, "needs `run`, the folder of a record"),
        ({"run": "b", "role": "held"}, "role of b is 'held'"),
        ({"run": "b", "hand": "both"}, "hand of b is 'both'"),
        ({"run": "b", "t0": "early"}, "t0 of b is early"),
        ({"run": "b", "t1": True}, "t1 of b is True"),
        ({"run": "c"}, "c is not a folder with a run record|c holds no"),
        ({"run": "b", "t0": 100.0}, "no hand holds anything"),
        ({"run": "a"}, "episode 'a' is listed twice"),
    ):
        with pytest.raises(GapError, match=told):
            asked({"run": "a"}, episode)
    with pytest.raises(GapError, match="no setting 'mass'"):
        asked({"run": "a"}, {"run": "b"}, mass=3.0)
