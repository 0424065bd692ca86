import base64
import json
from dataclasses import replace

import numpy as np
import pytest
from caretree.sim.log.messages import Observed, looked, quaternion, sent, stamp, stopped
from caretree.sim.log.schemas import SCHEMAS
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.world import BaseVelocity, GripperOpening, HandTwist, JointTrajectory


@pytest.fixture
def seen():
    rng = np.random.default_rng(0)
    measured = ScriptedWorld(seed=1).observe()
    return replace(measured, time=1.5, arm_positions=rng.normal(size=(2, 7)), arm_efforts=rng.normal(size=(2, 7)))


def contents(seen):
    return {topic: json.loads(text) for topic, _, text in Observed(BAXTER).messages(seen)}


def test_times_are_whole_nanoseconds():
    assert stamp(1.5) == {"sec": 1, "nsec": 500_000_000}
    assert stamp(2.9999999999) == {"sec": 3, "nsec": 0}, "no 10^9 nanoseconds"


def test_every_joint_is_told_under_its_own_name(seen):
    said = contents(seen)["/joint_states"]
    joints = {joint["name"]: joint for joint in said["joints"]}
    assert said["timestamp"] == stamp(1.5)
    for n, side in enumerate(("left", "right")):
        for k, name in enumerate(BAXTER.joints_of(side)):
            assert joints[name]["position"] == pytest.approx(seen.arm_positions[n, k], rel=1e-9)
            assert joints[name]["effort"] == pytest.approx(seen.arm_efforts[n, k], rel=1e-9)
        for finger in BAXTER.fingers[side]:
            assert 2.0 * joints[finger]["position"] == pytest.approx(seen.gripper_opening[n])
    assert joints["base_y"]["position"] == seen.pose_base_in_map[1]
    assert len(joints) == 14 + 4 + 1 + 3


def test_the_rest_has_its_places(seen):
    said = contents(replace(seen, emergency_stop=True))["/measured"]
    assert said["emergency_stop"] is True
    assert said["base_in_map"]["yaw"] == pytest.approx(seen.pose_base_in_map[2])
    assert said["right_hand"]["torque"]["x"] == pytest.approx(seen.wrench_hand_in_map[1, 3], rel=1e-9)


def test_a_number_that_is_none_is_null(seen):
    dead = replace(seen, wrench_hand_in_map=np.full((2, 6), np.nan))
    assert contents(dead)["/measured"]["left_hand"]["force"]["x"] is None


def test_a_picture_comes_with_depth_lens_and_place():
    frame = ScriptedWorld(seed=1).look("head")
    said = {(topic, schema): content for topic, schema, content in looked(frame)}
    image = said["/head_camera/image", "foxglove.CompressedImage"]
    assert base64.b64decode(image["data"]).startswith(b"\xff\xd8"), "a JPEG"
    raw = said["/head_camera/depth", "foxglove.RawImage"]
    depth = np.frombuffer(base64.b64decode(raw["data"]), "<u2").reshape(raw["height"], raw["width"])
    np.testing.assert_allclose(depth / 1000.0, frame.depth, atol=1e-3)
    assert said["/head_camera/calibration", "foxglove.CameraCalibration"]["K"][:3] == [30.0, 0.0, 16.0]
    (transform,) = said["/tf", "foxglove.FrameTransforms"]["transforms"]
    assert transform["translation"]["z"] == frame.pose_camera_in_map[2, 3]


def test_without_opencv_a_picture_is_raw(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "cv2", None)
    frame = ScriptedWorld(seed=1).look("head")
    (image,) = [content for topic, _, content in looked(frame) if topic == "/head_camera/image"]
    assert image["encoding"] == "rgb8"
    assert base64.b64decode(image["data"]) == frame.rgb.tobytes()


@pytest.mark.parametrize(
    "command",
    [
        JointTrajectory(joints=("left_w1",), times=np.array((0.0, 1.0)), positions=np.array(((0.0,), (0.5,)))),
        HandTwist(side="left", twist_in_map=np.arange(6.0)),
        BaseVelocity(velocity=np.array((0.1, 0.0, 0.2))),
        GripperOpening(side="right", opening=0.05),
    ],
)
def test_a_command_keeps_the_names_of_the_contract(command):
    topic, schema, content = sent(2.0, command)
    assert (topic, schema, content["command"]) == ("/sent", "caretree.Sent", type(command).__name__)
    for name, value in vars(command).items():
        assert content[name] == (value.tolist() if isinstance(value, np.ndarray) else value)
    json.dumps(content)
    assert stopped(2.0)[2]["command"] == "stop"


def test_quaternions_turn_as_their_matrices_do():
    rng = np.random.default_rng(3)
    for _ in range(200):
        q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        rotation = q * np.sign(np.linalg.det(q))
        x, y, z, w = quaternion(rotation)
        cross = np.array(((0, -z, y), (z, 0, -x), (-y, x, 0)))
        np.testing.assert_allclose(np.eye(3) + 2 * w * cross + 2 * cross @ cross, rotation, atol=1e-12)
        assert w >= 0.0


@pytest.mark.parametrize("name", SCHEMAS)
def test_every_schema_describes_an_object(name):
    assert SCHEMAS[name]["type"] == "object"
    assert SCHEMAS[name]["properties"]
