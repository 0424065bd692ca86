"""A master that is slow stops the robot for as long; one that is gone ends it for good."""

import pytest
from caretree.sim.ros1.clock import SLOW
from caretree.sim.ros1.master_watch import TIMES, UNHURRIED, MasterWatch
from caretree.sim.world import WorldError


class Master:
    """Answers, or takes `patience` to be found silent, or is not there."""

    def __init__(self):
        self.time, self.is_there, self.answers, self.asked = 0.0, True, True, []

    def ask(self, patience):
        self.asked.append(patience)
        if not self.is_there:
            raise WorldError("no ROS master answers: Connection refused") from ConnectionRefusedError()
        if not self.answers:
            self.time += patience
            raise WorldError("no ROS master answers: timed out") from TimeoutError()


@pytest.fixture
def master():
    return Master()


@pytest.fixture
def stops():
    return []


@pytest.fixture
def watch(master, stops):
    return MasterWatch(lambda: stops.append(master.time), ask=master.ask, now=lambda: master.time)


def test_a_master_that_answers_changes_nothing(watch, master, stops):
    watch.look()
    assert (watch.silent, watch.lost, stops, master.asked) == ("", "", [], [TIMES.slow])


def test_a_silent_master_stops_the_robot_within_half_a_second(watch, master, stops):
    watch.look()
    master.answers = False
    master.time += TIMES.look
    watch.look()
    assert 0.0 < stops[0] < 0.4, "which leaves a tenth of a second to brake in [s]"
    assert watch.silent == "no ROS master answers: timed out"
    assert watch.lost == ""


def test_it_is_stopped_again_and_again_and_goes_on_after_an_answer(watch, master, stops):
    master.answers = False
    watch.look()
    watch.look()
    assert len(stops) == 2
    master.answers = True
    watch.look()
    assert (len(stops), watch.silent, watch.lost) == (2, "", "")


def test_one_that_does_not_answer_for_long_is_lost_for_good(watch, master, stops):
    master.answers = False
    while master.time < TIMES.gone - TIMES.slow / 2.0:
        assert watch.lost == ""
        watch.look()
    assert watch.lost == "no ROS master answers: timed out"
    master.answers = True
    watch.look()
    assert watch.silent == watch.lost != ""


def test_one_that_is_not_there_is_lost_at_once_and_for_good(watch, master, stops):
    master.is_there = False
    watch.look()
    assert stops == [0.0]
    master.is_there = True
    watch.look()
    assert watch.silent == watch.lost == "no ROS master answers: Connection refused"


def test_a_stop_that_fails_is_tried_again(master):
    tried = []

    def stop():
        tried.append(master.time)
        raise WorldError("nobody listens")

    watch = MasterWatch(stop, ask=master.ask, now=lambda: master.time)
    master.is_there = False
    watch.look()
    watch.look()
    assert len(tried) == 2


def test_where_time_waits_for_the_tree_the_master_may_take_as_long_as_the_robot(master, stops):
    watch = MasterWatch(lambda: stops.append(master.time), UNHURRIED, ask=master.ask, now=lambda: master.time)
    watch.look()
    assert master.asked == [SLOW]
    master.answers = False
    watch.look()
    assert stops == [SLOW]
    assert watch.lost != ""


def test_what_it_took_to_begin_is_not_held_against_it(watch, master):
    master.time = 2.0 * TIMES.gone
    watch.begin()
    watch.end()
    master.answers = False
    watch.look()
    assert watch.lost == ""
