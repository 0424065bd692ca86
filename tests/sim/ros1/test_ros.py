"""ROS that is not there, and a master that is not there, are told in one sentence."""

import importlib
import subprocess
import sys
from types import SimpleNamespace

import pytest
from caretree.sim.ros1 import ros as module
from caretree.sim.ros1.ros import RosMissing, ask_master, others_have, ros
from caretree.sim.world import WorldError


def test_a_machine_without_ros_is_told_what_to_do(monkeypatch):
    def missing(name):
        raise ModuleNotFoundError(f"No module named {name!r}")

    ros.cache_clear()
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setattr(importlib, "import_module", missing)
    with pytest.raises(RosMissing, match=r"ROS 1 is not on this machine .*rospy.*; `make ros` installs"):
        ros()


def test_nobody_is_imported_before_he_is_asked_for():
    code = "import caretree.sim.ros1.world, sys; sys.exit('rospy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], timeout=120).returncode == 0


@pytest.mark.parametrize("uri", ["http://127.0.0.1:9", "nowhere"])
def test_a_master_that_is_not_there_is_told(monkeypatch, uri):
    monkeypatch.setenv("ROS_MASTER_URI", uri)
    with pytest.raises(WorldError, match=f"no ROS master answers at {uri}: "):
        ask_master("getPid")
    assert module.master_uri() == uri


def test_a_topic_that_only_this_process_asks_for_is_had_by_nobody(monkeypatch):
    state = ([["/state", ["/robot"]]], [["/alone", ["/me"]], ["/arm/goal", ["/robot"]], ["/state", ["/me"]]], [])
    monkeypatch.setattr(module, "ros", lambda: SimpleNamespace(rospy=SimpleNamespace(get_name=lambda: "/me")))
    monkeypatch.setattr(module, "ask_master", lambda what: state)
    assert others_have(["/state", "/alone", "/arm", "/nowhere"]) == {"/state", "/arm"}
