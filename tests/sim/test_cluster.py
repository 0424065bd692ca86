"""Calls on a cluster: as many in flight as it has cores, a lost worker loses its own call, errors are told."""

import sys

import pytest
from caretree.sim.cluster import Cluster, LostCallError
from caretree.sim.errors import CaretreeError

from ..fake_ray import FakeRay


def double(number):
    if number == 13:
        raise CaretreeError("thirteen")
    return 2 * number


@pytest.fixture
def ray(monkeypatch):
    fake = FakeRay(cores=3)
    monkeypatch.setitem(sys.modules, "ray", fake)
    return fake


def test_as_many_calls_are_in_flight_as_there_are_cores(ray):
    with Cluster("ray://head:10001", None, "this") as cluster:
        found = dict(cluster.each(double, [(n,) for n in range(7)]))
    assert found == {(n,): 2 * n for n in range(7)}
    assert ray.most_in_flight == 3
    assert ray.left


def test_a_lost_worker_loses_its_own_call_only(ray):
    ray.killed = {2}
    with Cluster(None, 2, "this") as cluster:
        found = dict(cluster.each(double, [(n,) for n in range(4)]))
    assert isinstance(found.pop((2,)), LostCallError)
    assert found == {(0,): 0, (1,): 2, (3,): 6}


def test_an_error_of_the_call_is_raised_and_the_others_are_cancelled(ray):
    with pytest.raises(CaretreeError, match="thirteen"), Cluster(None, 2, "this") as cluster:
        list(cluster.each(double, [(13,), (1,), (2,)]))
    assert ray.cancelled == [1]


def test_without_ray_or_without_an_answer_one_sentence_says_so(ray, monkeypatch):
    with pytest.raises(CaretreeError, match=r"no Ray cluster answers at ray://nobody: timeout$"):
        Cluster("ray://nobody", None, "this")
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(CaretreeError, match=r"--address needs Ray: pip install 'caretree\[ray\]'"):
        Cluster(None, 2, "--address")
