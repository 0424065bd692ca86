"""Every stage, skill, failure and fault is in the drawing, and long names leave room for it."""

from xml.etree import ElementTree as ET

from caretree.trees.report.bars import telling_skills, timeline
from caretree.trees.report.figures import STATUS
from caretree.trees.report.timeline import Span


def height_of(svg):
    return float(ET.fromstring(svg).get("viewBox").split()[3])


def words_of(svg):
    return [word.text for word in ET.fromstring(svg).iter("text")]


def test_bars_begin_and_end_on_the_time_axis_in_the_colour_of_their_end():
    stage = {"name": "lay", "status": "success", "t_start": 0.0, "t_end": 10.0}
    spans = [
        Span(path="task/take", t_start=0.0, t_end=5.0, status="FAILURE"),
        Span(path="task/take", t_start=5.0, t_end=10.0, status="SUCCESS"),
    ]
    drawn = timeline([stage], spans, 10.0)
    bars = [
        (float(bar.get("x")), float(bar.get("width")), bar.get("fill")) for bar in ET.fromstring(drawn).iter("rect")
    ]
    (x, whole, _), first, second = bars
    assert [bar[2] for bar in bars] == [STATUS["success"], STATUS["failure"], STATUS["success"]]
    assert first[:2] == (x, whole / 2)
    assert second[0] == round(x + whole / 2, 1)
    assert words_of(drawn)[:11] == [str(second) for second in range(11)], "a line for every second"
    assert {"lay", "take"} <= set(words_of(drawn))
    assert drawn.count("#7d1f18") == 1, "one cross"


def test_a_name_is_text_whatever_it_holds():
    name = "<script>alert('x')</script> & \u4e2d"
    assert name in words_of(timeline([], [Span(path="x", label=name, t_start=0.0, t_end=1.0, status="SUCCESS")], 1.0))


def test_the_name_of_a_fault_has_room_above_a_short_timeline():
    span = Span(path="task/wait", t_start=0.0, t_end=2.0, status="SUCCESS")
    name = "dead_sensor@wait for the hand of the person:step"
    assert height_of(timeline([], [span], 2.0, [(1.0, name)])) > height_of(timeline([], [span], 2.0))


def test_names_of_thousands_of_letters_leave_room_for_the_timeline():
    name = 5000 * "9"
    span = Span(path=f"task/{name}", t_start=0.0, t_end=2.0, status="FAILURE")
    stage = {"name": name, "status": "failure", "t_start": 0.0, "t_end": 2.0}
    drawn = timeline([stage], [span], 2.0, [(1.0, f"dead_sensor@{name}:step")])
    assert height_of(drawn) <= 1.1 * height_of(timeline([stage], [span], 2.0, [(1.0, 60 * "x")]))


def test_of_too_many_skills_those_are_drawn_that_failed_or_took_longest():
    def span(name, start, seconds, status="SUCCESS"):
        return Span(path=f"task/{name}", t_start=start, t_end=start + seconds, status=status)

    spans = [span("wait", 0.0, 0.1), span("drive", 1.0, 9.0), span("look", 10.0, 0.2), span("take", 11.0, 3.0)]
    spans += [span("look", 14.0, 0.2), span("lay", 15.0, 0.3, "FAILURE")]
    assert telling_skills(spans) == (["wait", "drive", "look", "take", "lay"], 0)
    assert telling_skills(spans, most=3) == (["drive", "take", "lay"], 2)
