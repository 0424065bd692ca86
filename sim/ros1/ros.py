"""ROS 1, imported when somebody asks for it, and one node a process.

Debian keeps rospy in a folder of its own Python.  It is put at the END of the path: what this environment brings goes
first, where PYTHONPATH would have Debian's numpy shadow it.
"""

from __future__ import annotations

import http.client
import importlib
import os
import sys
import threading
import warnings
import xmlrpc.client
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from ..world import WorldError

DEBIAN = "/usr/lib/python3/dist-packages"
MODULES = (
    "rospy",
    "genpy",
    "rosgraph_msgs.msg",
    "std_msgs.msg",
    "sensor_msgs.msg",
    "geometry_msgs.msg",
    "nav_msgs.msg",
    "trajectory_msgs.msg",
    "actionlib_msgs.msg",
)
INSTALL = "`make ros` installs what Debian carries of it"
MASTER = "http://localhost:11311"
ANSWER = 1.0  # [s] that a master may take to answer
ANSWER_TO_NODE = 5.0  # [s] the same for rospy, which would wait for ever, at the end of a process too
_ONE = threading.Lock()
_node = ""  # the master to which this process belongs


class RosMissing(WorldError):  # noqa: N818 it names a state of the machine
    """ROS 1 is not on this machine, or not for this Python."""


@lru_cache
def ros() -> Any:
    """The modules in `MODULES`, by their name up to the first dot (`ros().sensor_msgs.JointState`).

    Raises:
        RosMissing: ROS 1 is not there.
    """
    if DEBIAN not in sys.path and Path(DEBIAN, "rospy").is_dir():
        sys.path.append(DEBIAN)
    found = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it is older than this Python
        for name in MODULES:
            try:
                found[name.partition(".")[0]] = importlib.import_module(name)
            except ImportError as error:
                raise RosMissing(f"ROS 1 is not on this machine ({error}); {INSTALL}") from error
    return SimpleNamespace(**found)


def master_uri() -> str:
    """Where the master is said to be."""
    return os.environ.get("ROS_MASTER_URI", MASTER)


class _Patient(xmlrpc.client.Transport):
    """Gives up after a while."""

    def __init__(self, patience: float) -> None:
        super().__init__()
        self._patience = patience

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = self._patience
        return connection


def ask_master(what: str, *values: Any, patience: float = ANSWER) -> Any:
    """Ask the master something; `what` is a call of its XML-RPC interface.

    Raises:
        WorldError: it does not answer.
    """
    uri = master_uri()
    try:
        master: Any = xmlrpc.client.ServerProxy(uri, transport=_Patient(patience))
        code, said, answer = getattr(master, what)("/caretree", *values)
    except (OSError, http.client.HTTPException, xmlrpc.client.Error, ValueError) as error:
        why = getattr(error, "strerror", None) or error or type(error).__name__
        raise WorldError(f"no ROS master answers at {uri}: {why}") from error
    if code != 1:
        raise WorldError(f"the ROS master at {uri} refuses {what}: {said}")
    return answer


def node(name: str, master: str = "") -> Any:
    """Make this process a node, once, and return rospy.

    Args:
        name: of the node; a number is added to it.
        master: address; what ROS_MASTER_URI says where it is empty.

    Raises:
        WorldError: no master answers, or the process belongs to another one.
    """
    global _node
    if master:
        os.environ["ROS_MASTER_URI"] = master
    ask_master("getPid")
    rospy = ros().rospy
    with _ONE:
        uri = master_uri()
        if _node and _node != uri:
            raise WorldError(f"this process is a node of the master at {_node} already, and cannot be one at {uri}")
        if not _node:
            # the one by which rospy asks: it makes its own where it finds none
            patient = rospy.core._LockedServerProxy(uri, transport=_Patient(ANSWER_TO_NODE))
            rospy.core._xmlrpc_cache[uri] = patient
            # stamps are read from /clock by `clock.py`, which knows what to do where it stands still
            rospy.init_node(name, anonymous=True, disable_signals=True, disable_rosout=True, disable_rostime=True)
            _node = uri
    return rospy


def others_have(names: Iterable[str]) -> set[str]:
    """Which of these topics and actions another node gives or takes, as the master knows it.

    Raises:
        WorldError: it does not answer.
    """
    here = ros().rospy.get_name()
    given, taken, _ = ask_master("getSystemState")
    known = {topic for topic, nodes in (*given, *taken) if set(nodes) - {here}}
    return {name for name in names if name in known or f"{name}/goal" in known}


def publisher(rospy: Any, topic: str, kind: Any, *, at_once: bool = False) -> Any:
    """A publisher of single messages.

    Args:
        rospy: the node.
        topic: its name.
        kind: class of its messages.
        at_once: each message is handed over before `publish` returns, so messages of several topics keep their order.
            A robot that no longer listens would then hold up who publishes: only for simulated ones.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of publishing without a queue, which is meant
        return rospy.Publisher(topic, kind, queue_size=None if at_once else 1, tcp_nodelay=True)
