"""Planted harms: the evaluator finds each, says which, and says of each what the outside judge says."""

import re
from collections.abc import Callable

import numpy as np
import pytest
from caretree.sim.errors import RecordError
from caretree.sim.evaluate.unharmed_rows import ROWS
from caretree.sim.evaluate.verdict import evaluate

Arrays = dict[str, np.ndarray]
SHEET = 165  # vertices of the gown's sheet, 15 rows of 11 along the body
THICK = 0.04  # [m] radius of the planted links


def nothing(z: Arrays) -> None:
    """The good record."""


def link(z: Arrays, name: str, place: tuple[float, float, float], frames: slice) -> None:
    """Add a link of 4 cm across the person, which comes to `place` in some frames."""
    far = np.tile(np.float32([0.0, 0.0, 3.0, 0.0, 0.0, 3.1, THICK]), (len(z["t"]), 1))
    x, y, height = place
    far[frames] = (x - 0.02, y, height, x + 0.02, y, height, THICK)
    z["robot_capsules"] = np.concatenate([z["robot_capsules"], far[:, None]], axis=1)
    z["robot_capsule_names"] = np.append(z["robot_capsule_names"], name)


def palm(part: str, depth: float, name: str = "left_palm_1") -> Callable[[Arrays], None]:
    """A palm this deep [m] in a part of the person, in one frame."""
    skin = {"neck_head": (0.0, -0.2, 0.08), "trunk": (0.0, 0.3, 0.0), "right upper arm": (0.28, 0.15, 0.05)}[part]

    def plant(z: Arrays) -> None:
        link(z, name, (*skin[:2], skin[2] + THICK - depth), slice(40, 41))

    return plant


def finger(holds: int, frames: slice, name: str = "left_finger_1") -> Callable[[Arrays], None]:
    """A finger 20 mm in the right forearm in frames 30 to 40, of a hand that `holds` an arm in `frames`."""

    def plant(z: Arrays) -> None:
        link(z, name, (0.28, 0.42, 0.045 + THICK - 0.020), slice(30, 41))
        z["holds_arm"][frames, 0] = holds

    return plant


def arm_up(frames: slice, height: float) -> Callable[[Arrays], None]:
    """The left wrist and hand `height` above the mattress [m], thin, so that the sleeve is clear of them."""

    def plant(z: Arrays) -> None:
        z["arm_radii"] *= 0.2
        z["arms"][frames, 0, 2:, 2] = z["bed_top"] + height

    return plant


def gown_passes_the_face(y: float, height: float = 0.0) -> Callable[[Arrays], None]:
    """The face where the sheet, 3 cm above the bed, slides over it at the start of its way."""

    def plant(z: Arrays) -> None:
        z["face"] = np.float32([0.007, y, height, 0.0, 0.0, 1.0])

    return plant


def neckline(row: int, column: int, aside: float = 0.0) -> Callable[[Arrays], None]:
    """The neckline about another vertex of the sheet, which is moved aside [m]."""
    middle = 11 * row + column

    def plant(z: Arrays) -> None:
        z["neckline"] = np.array([middle - 1, middle, middle + 1])
        z["vertices"][:, middle, 0] += aside
        z["rest_vertices"][middle, 0] += aside

    return plant


def more_sheets(count: int) -> Callable[[Arrays], None]:
    """Lay the lower half of the sheet over itself, this often."""

    def plant(z: Arrays) -> None:
        lower = np.arange(7 * 11, SHEET)
        sheet = z["faces"][np.isin(z["faces"], lower).all(axis=1)]
        for k in range(1, count + 1):
            first = len(z["rest_vertices"])
            lift = np.float32([0.0, 0.0, 0.02 * k])
            z["rest_vertices"] = np.concatenate([z["rest_vertices"], z["rest_vertices"][lower] + lift])
            z["vertices"] = np.concatenate([z["vertices"], z["vertices"][:, lower] + lift], axis=1)
            z["faces"] = np.concatenate([z["faces"], sheet - lower[0] + first])

    return plant


def inside_out_below(y: float) -> Callable[[Arrays], None]:
    def plant(z: Arrays) -> None:
        below = z["rest_vertices"][z["faces"]][:, :, 1].mean(axis=1) > y
        z["faces"][below] = z["faces"][below][:, ::-1]

    return plant


def force(part: str, newtons: float) -> Callable[[Arrays], None]:
    def plant(z: Arrays) -> None:
        z["person_parts"] = np.array(["trunk", part, "legs"])
        z["person_force"][:, 2] = np.nan  # not measured
        z["person_force"][30, 1] = newtons

    return plant


def moving_head(z: Arrays) -> None:
    """The person's head comes up to the hand for one frame."""
    z["person_capsules"] = np.tile(z["person_capsules"], (len(z["t"]), 1, 1))
    link(z, "right_palm_1", (0.0, -0.2, 0.3), slice(None))
    z["person_capsules"][50, 0, [2, 5]] = 0.2


def two_harms(z: Arrays) -> None:
    palm("neck_head", 0.05)(z)
    palm("trunk", 0.03, "right_forearm")(z)


# what was planted, and the sentences that are asked for; none means unharmed
HARMS: dict[str, tuple[Callable[[Arrays], None], list[str]]] = {
    "nothing": (nothing, []),
    "hand in the head by 3 mm": (palm("neck_head", 0.003), [r"left palm 1 .* 3\.0 mm inside .* neck head at 3\.2 s"]),
    "hand in the head by 1 mm": (palm("neck_head", 0.001), []),
    "hand in the trunk by 12 mm": (palm("trunk", 0.012), [r"left palm 1 .* 12\.0 mm inside .* trunk"]),
    "hand in the trunk by 8 mm": (palm("trunk", 0.008), []),
    "the robot's head in the trunk": (palm("trunk", 0.012, "head"), [r"the head of the robot is 12\.0 mm inside"]),
    "palm in an arm": (palm("right upper arm", 0.015), [r"15\.0 mm inside the person's right upper arm"]),
    "finger in the arm that it holds": (finger(1, slice(30, 41)), []),
    "finger in the arm, one frame early and late": (finger(1, slice(31, 40)), []),
    "finger in the arm, two frames late": (finger(1, slice(30, 39)), [r"left finger 1 .* right forearm at 3\.2 s"]),
    "finger in the arm while it holds the other": (finger(0, slice(30, 41)), [r"left finger 1 .* right forearm"]),
    "finger in the arm while it holds none": (finger(-1, slice(30, 41)), [r"left finger 1 .* right forearm"]),
    "finger of the other hand": (finger(1, slice(30, 41), "right_finger_2"), [r"right finger 2 .* right forearm"]),
    "wrist in the arm that the hand holds": (finger(1, slice(30, 41), "left_wrist"), [r"left wrist .* right forearm"]),
    "head and trunk": (two_harms, [r"left palm 1 .* neck head", r"right forearm .* trunk"]),
    "head that moves": (moving_head, [r"right palm 1 .* 20\.0 mm inside the person's neck head at 4\.0 s"]),
    "arm up at the end": (arm_up(slice(-3, None), 0.25), [r"left wrist ends 0\.250 m .* the arm does not lie"]),
    "arm across the belly at the end": (arm_up(slice(-3, None), 0.19), []),
    "arm up before": (arm_up(slice(20, 60), 0.4), []),
    "cloth on the face for 1.5 s": (gown_passes_the_face(2.025), [r"cloth lies on the face for 1\.\d\d s"]),
    "cloth on the face for 0.6 s": (gown_passes_the_face(2.40), []),
    "cloth 13 cm over the face": (gown_passes_the_face(2.025, -0.10), []),
    "neckline 12 cm aside": (neckline(0, 7, 0.02), [r"neckline lies 0\.120 m beside the middle"]),
    "neckline 12 cm to the other side": (neckline(0, 3, -0.02), [r"neckline lies 0\.120 m beside the middle"]),
    "neckline 5 cm aside": (neckline(0, 6), []),
    "neckline on the breast": (neckline(3, 5), [r"neckline lies 0\.100 m from the shoulders towards the feet"]),
    "three layers": (more_sheets(2), [r"three and more layers lie on 0\.5\d"]),
    "two layers": (more_sheets(1), []),
    "inside out on a third": (inside_out_below(0.40), [r"outside is out on 0\.67 of the covered torso"]),
    "inside out at the seam": (inside_out_below(0.55), []),
    "70 N on the head": (force("head", 70.0), [r"force on the head reaches 70 N at 2\.4 s, 65 N are allowed"]),
    "60 N on the head": (force("head", 60.0), []),
    "155 N on an upper arm": (force("left_upper_arm", 155.0), [r"left upper arm reaches 155 N .* 150 N"]),
    "145 N on an upper arm": (force("left_upper_arm", 145.0), []),
    "500 N on a part without a limit": (force("knee", 500.0), []),
}


@pytest.mark.filterwarnings("ignore:All-NaN:RuntimeWarning")  # the judge's, on forces that were not measured
@pytest.mark.parametrize("name", HARMS)
def test_a_planted_harm_is_found_and_nothing_else(damaged_record, outside_judge, name):
    plant, sentences = HARMS[name]
    directory = damaged_record(plant)
    verdict = evaluate(directory)
    assert len(verdict.problems) == len(sentences), verdict.problems
    for sentence, problem in zip(sentences, verdict.problems, strict=True):
        assert re.search(sentence, problem), problem
    assert (verdict.dressed, verdict.unharmed) == (not sentences, not sentences)
    if outside_judge is not None:
        theirs = outside_judge.judge(directory)
        assert (theirs["dressed"], theirs["unharmed"]) == (verdict.dressed, verdict.unharmed), theirs["problems"]
        assert len(theirs["problems"]) == len(sentences)


def test_an_undressed_person_may_be_unharmed(damaged_record, outside_judge):
    def still_gripped(z: Arrays) -> None:
        z["gripper_closed"][-1, 0] = True

    directory = damaged_record(still_gripped)
    verdict = evaluate(directory)
    assert (verdict.dressed, verdict.unharmed) == (False, True)
    if outside_judge is not None:
        assert outside_judge.judge(directory)["unharmed"] is True


@pytest.mark.parametrize("missing", ROWS)
def test_one_missing_row_is_a_problem(damaged_record, outside_judge, missing):
    directory = damaged_record(lambda z: z.pop(missing))
    verdict = evaluate(directory)
    assert (verdict.dressed, verdict.unharmed) == (False, None)
    assert verdict.problems == (f"the record lacks {missing}",)
    if outside_judge is not None:
        theirs = outside_judge.judge(directory)
        assert (theirs["dressed"], theirs["unharmed"], theirs["problems"]) == (False, None, [*verdict.problems])


def test_old_records_are_judged_without_the_rows(damaged_record, outside_judge):
    def forget(z: Arrays) -> None:
        inside_out_below(0.40)(z)
        for name in ROWS:
            del z[name]

    directory = damaged_record(forget)
    verdict = evaluate(directory)
    assert (verdict.dressed, verdict.unharmed) == (True, None)
    if outside_judge is not None:
        theirs = outside_judge.judge(directory)
        assert (theirs["dressed"], theirs["unharmed"]) == (True, None)


def test_a_link_at_no_place_is_a_problem_and_unknown(damaged_record):
    def lose(z: Arrays) -> None:
        z["robot_capsules"][7, 0, 2] = np.nan

    verdict = evaluate(damaged_record(lose))
    assert verdict.problems == ("robot_capsules holds a number that is not finite",)
    assert (verdict.dressed, verdict.unharmed) == (False, None)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("neckline", np.array([10_000]), "neckline holds something else than vertex numbers"),
        ("neckline", np.array([], dtype=int), "neckline names no vertices"),
        ("face", np.zeros(3), "face has shape"),
        ("holds_arm", np.zeros((3, 2), dtype=int), "holds_arm has shape"),
        ("person_capsules", np.zeros((5, 7)), "person_capsule_names has shape"),
        ("person_capsules", np.zeros((9, 2, 7)), "person_capsules has shape"),
        ("person_force", None, "lacks person_force"),
        ("robot_capsule_names", np.arange(2), "but text"),
    ],
)
def test_bad_rows_are_one_sentence(damaged_record, name, value, message):
    def spoil(z: Arrays) -> None:
        z.pop(name)
        if value is not None:
            z[name] = value

    with pytest.raises(RecordError, match=message):
        evaluate(damaged_record(spoil))


def test_same_numbers(damaged_record, judge):
    """Links that wander about the person, the gown lying askew."""
    rng = np.random.default_rng(6)

    def wander(z: Arrays) -> None:
        neckline(1, 6)(z)
        more_sheets(2)(z)
        gown_passes_the_face(2.1)(z)
        names = ["left_palm", "left_finger_1", "right_finger_2", "right_forearm", "head"]
        start = rng.uniform(-0.5, 0.5, (len(z["t"]), len(names), 3))
        z["robot_capsules"] = np.concatenate(
            [start, start + rng.normal(0, 0.08, start.shape), np.full((*start.shape[:2], 1), 0.03)], axis=2
        ).astype(np.float32)
        z["robot_capsule_names"] = np.array(names)
        z["holds_arm"] = rng.integers(-1, 2, z["holds_arm"].shape)
        z["arms"][-1, 1, 2, 2] += 0.03

    directory = damaged_record(wander)
    ours, theirs = evaluate(directory), judge.judge(directory)
    assert (ours.dressed, ours.unharmed) == (theirs["dressed"], theirs["unharmed"]) == (False, False)
    assert len(ours.problems) == len(theirs["problems"])
    numbers = ours.numbers
    for name, value in {
        "wrist_left_above_bed_m": theirs["wrist_above_bed_m"]["left"],
        "wrist_right_above_bed_m": theirs["wrist_above_bed_m"]["right"],
        "neckline_aside_m": theirs["neckline_middle_m"][0],
        "neckline_along_m": theirs["neckline_middle_m"][1],
        "three_layers": theirs["three_layers"],
        "force_torso_n": theirs["force_peak_n"]["torso"],
    }.items():
        assert numbers[name] == pytest.approx(value, abs=6e-4), name
    assert numbers["face_covered_s"] == pytest.approx(theirs["face_covered_s"], abs=6e-3)
    for name, key in (("robot_depth_head_m", "head or neck"), ("robot_depth_elsewhere_m", "elsewhere")):
        depth, _ = theirs["robot_depth_m"][key]
        assert depth > 0.01
        assert depth - 1e-4 <= numbers[name] <= depth + 4e-3, "the judge looks at nine points of a link"
