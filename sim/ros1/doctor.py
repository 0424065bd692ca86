"""What a robot behind a master lacks before anything moves: missing, too old, too slow, of another frame."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..world import SIDES, WorldError
from .clock import SIMULATED, RosTime, parameter
from .messages import message
from .room import read_room
from .ros import ask_master, master_uri, node, ros
from .site import DEFAULT, Site, read_site

CONNECTED = 5.0  # [s] that those who are there may take to be connected
AHEAD = 0.05  # [s] by which a stamp may be ahead: clocks of two computers differ


@dataclass(frozen=True)
class Finding:
    """One thing looked at.

    Attributes:
        what: was looked at.
        well: nothing is wrong with it.
        said: about it.
    """

    what: str
    well: bool
    said: str

    def __str__(self) -> str:
        return f"{'ok  ' if self.well else 'BAD '} {self.what}: {self.said}"


@dataclass
class _Topic:
    """What is asked of a topic, and what has come."""

    name: str
    kind: Any
    rate: float = 0.0  # [Hz] at least; 0 where one message is enough
    frame: str = ""
    joints: tuple[str, ...] = ()
    stamped: bool = True
    ages: list[float] = field(default_factory=list)
    last: Any = None


def examine(site_name: str = DEFAULT, seconds: float = 2.0) -> list[Finding]:
    """Look at everything.

    Args:
        site_name: as for `read_site`.
        seconds: how long to listen [s].

    Raises:
        SiteError: the site file is not as it should be.
        RosMissing: ROS is not there.
    """
    site = read_site(site_name)
    findings = [Finding("site", True, f"{site_name}, a {site.robot}")]
    ros()
    try:
        ask_master("getPid")
    except WorldError as error:
        return [*findings, Finding("master", False, str(error))]
    findings += [Finding("master", True, f"answers at {master_uri()}"), _own_address()]
    rospy = node("doctor")
    topics, clock = _topics(site), RosTime(rospy, bool(parameter(SIMULATED, False)))
    listening = [rospy.Subscriber(each.name, each.kind, _note, (each, clock)) for each in topics]
    try:
        published, subscribed, kinds = _known()
        given = [n for n, each in enumerate(topics) if each.name in published]
        ends = time.monotonic() + CONNECTED
        while time.monotonic() < ends and not (
            clock.now() > 0.0 and all(listening[n].get_num_connections() for n in given)
        ):
            time.sleep(0.02)
        if clock.simulated:
            running = clock.now() > 0.0
            findings.append(Finding("/clock", running, "tells the time" if running else "is asked for, and silent"))
        before, began = clock.now(), time.monotonic()
        for each in topics:
            each.ages.clear()
        time.sleep(seconds)
        passed = clock.now() - before
        if clock.simulated and passed <= 0.1 * (time.monotonic() - began):
            findings.append(Finding("/clock", False, "stands still, or nearly: rates are told of its own time"))
    finally:
        for each in listening:
            each.unregister()
        clock.close()
    ages = (-AHEAD - clock.step, site.fresh)
    findings += [_judge(each, passed, ages, published, kinds) for each in topics]
    findings += _judge_listeners(site, subscribed, kinds)
    findings += _judge_state(next(each for each in topics if each.name == site.state.topic))
    return [*findings, _judge_room(rospy, site)]


def _own_address() -> Finding:
    """A node that calls itself by a name that others cannot resolve hears nothing."""
    own = os.environ.get("ROS_IP") or os.environ.get("ROS_HOSTNAME")
    far = not any(near in master_uri() for near in ("localhost", "127.0.0.1"))
    if far and not own:
        return Finding("own address", False, "the master is on another computer: set ROS_IP to this one's address")
    return Finding("own address", True, own or "this computer's name")


def _topics(site: Site) -> list[_Topic]:
    there = ros()
    joints = tuple(name for side in SIDES for name in site.arms[side].joints) + (site.head.joint,)
    state, wrench = there.sensor_msgs.JointState, there.geometry_msgs.WrenchStamped
    base, place = site.base, there.geometry_msgs.PoseWithCovarianceStamped
    found = [
        _Topic(site.joint_states.topic, state, site.joint_states.rate, joints=joints),
        _Topic(site.state.topic, message("baxter_core_msgs/AssemblyState"), site.state.rate, stamped=False),
        _Topic(base.odometry, there.nav_msgs.Odometry, base.rate, frame=base.odometry_frame),
        _Topic(base.pose, place, frame=base.map_frame, stamped=False),  # it comes when the base moves
    ]
    for side in SIDES:
        grip, wrist = site.grippers[side], site.wrists[side]
        found.append(_Topic(grip.state, state, grip.rate, joints=(grip.joint,)))
        found.append(_Topic(wrist.topic, wrench, wrist.rate, frame=wrist.frame))
    image, info = there.sensor_msgs.Image, there.sensor_msgs.CameraInfo
    for camera in site.cameras.values():
        for name, kind in ((camera.colour, image), (camera.depth, image), (camera.info, info)):
            found.append(_Topic(name, kind, camera.rate, frame=camera.frame))
    return found


def _note(heard: Any, more: tuple[_Topic, RosTime]) -> None:
    topic, clock = more
    topic.last = heard
    topic.ages.append(clock.now() - heard.header.stamp.to_sec() if topic.stamped else 0.0)


def _known() -> tuple[set[str], set[str], dict[str, str]]:
    """Topics that somebody gives, that somebody takes, and their kinds, as the master knows them."""
    given, taken, _ = ask_master("getSystemState")
    return {name for name, _ in given}, {name for name, _ in taken}, dict(ask_master("getTopicTypes"))


def _judge(
    topic: _Topic, passed: float, ages: tuple[float, float], published: set[str], kinds: dict[str, str]
) -> Finding:
    def bad(said: str) -> Finding:
        return Finding(topic.name, False, said)

    if topic.name not in published:
        return bad(f"nobody gives it; {topic.kind._type} is asked for")
    if (kind := kinds.get(topic.name, topic.kind._type)) not in (topic.kind._type, "*"):
        return bad(f"is {kind}, but {topic.kind._type} is asked for")
    if topic.last is None:
        return bad("is given by somebody, but nothing comes: can this computer be reached from the robot's?")
    if topic.frame and (frame := topic.last.header.frame_id.lstrip("/")) != topic.frame:
        return bad(f"is in frame {frame or 'nothing'!r}, but {topic.frame!r} is asked for")
    if topic.joints and (missing := [name for name in topic.joints if name not in topic.last.name]):
        return bad(f"lacks joint {', '.join(missing)}")
    rate = len(topic.ages) / max(passed, 1e-3)
    if rate < 0.8 * topic.rate:
        return bad(f"comes {rate:.1f} times a second, but {topic.rate:g} is asked for")
    if not (topic.rate and topic.stamped):
        return Finding(topic.name, True, "comes")
    age = float(np.median(topic.ages))
    if not ages[0] <= age <= ages[1]:
        why = "stamps are ahead of this computer's clock" if age < 0.0 else "it is too old, or the clocks differ"
        return bad(f"is {age:.2f} s old, but 0 to {ages[1]:g} s is asked for: {why}")
    return Finding(topic.name, True, f"{rate:.0f} Hz, {1e3 * age:.0f} ms old")


def _judge_listeners(site: Site, subscribed: set[str], kinds: dict[str, str]) -> list[Finding]:
    goals = {site.arms[side].trajectory: "FollowJointTrajectory" for side in SIDES}
    goals |= {site.grippers[side].action: "GripperCommand" for side in SIDES}
    goals[site.head.action] = "SingleJointPosition"
    wanted = {f"{name}/goal": f"control_msgs/{kind}ActionGoal" for name, kind in goals.items()}
    wanted |= {site.arms[side].velocity: "baxter_core_msgs/JointCommand" for side in SIDES}
    wanted |= {site.base.command: "geometry_msgs/Twist"}
    findings = []
    for name, kind in wanted.items():
        given = kinds.get(name, kind)
        if name not in subscribed:
            findings.append(Finding(name, False, f"nobody takes it; {kind} would be sent"))
        elif given not in (kind, "*"):
            findings.append(Finding(name, False, f"is {given}, but {kind} would be sent"))
        else:
            findings.append(Finding(name, True, "is taken"))
    heard = site.alive in subscribed
    said = "is heard" if heard else "nobody hears it: if this computer dies, a trajectory goes on to its end"
    return [*findings, Finding(site.alive, heard, said)]


def _judge_state(topic: _Topic) -> list[Finding]:
    state = topic.last
    if state is None:
        return []
    if state.estop_button or state.stopped:
        return [Finding("emergency stop", False, "is pressed, or was and the robot is not enabled again")]
    if state.error or not state.enabled:
        return [Finding("robot", False, "has an error" if state.error else "is not enabled")]
    return [Finding("robot", True, "is enabled, and its emergency stop is not pressed")]


def _judge_room(rospy: Any, site: Site) -> Finding:
    try:
        room = read_room(rospy, site, 1.0)
    except WorldError as error:
        return Finding("map", False, str(error))
    return Finding("map", True, f"{room.free.shape[1]} x {room.free.shape[0]} cells, {len(room.waypoints)} waypoints")
