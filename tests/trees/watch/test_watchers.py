"""Those who were asked for watch, and nobody else is loaded, served or left behind."""

from argparse import Namespace

import pytest
from caretree.sim.errors import CaretreeError
from caretree.trees.groot.publisher import Publisher
from caretree.trees.watch import live
from caretree.trees.watch.watchers import Watchers

from ..groot.conftest import free_port

NOBODY = {"view": False, "port": None, "groot": None, "task": "wave", "seed": 0}


def test_nobody_costs_nothing(tmp_path, capsys):
    nobody = Watchers(Namespace(**NOBODY))
    assert nobody.before_tick is None
    nobody.event({"kind": "node", "node": "a", "status": "RUNNING", "t": 0.0})
    nobody.finish("done", tmp_path)
    nobody.close()
    assert capsys.readouterr().out == ""


def test_a_port_for_no_view_is_refused():
    with pytest.raises(CaretreeError, match="give --view too"):
        Watchers(Namespace(**NOBODY | {"port": 8080}))


def test_where_one_of_two_cannot_be_served_the_other_is_closed(monkeypatch):
    def fails(title, port):
        raise CaretreeError("no viser")

    monkeypatch.setattr(live, "LiveView", fails)
    port = free_port()
    with pytest.raises(CaretreeError, match="no viser"):
        Watchers(Namespace(**NOBODY | {"view": True, "groot": port}))
    Publisher(port).close()  # the ports are free again
