"""Laws of what a world measures."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from ..freshness import fresh_frame
from ..mechanics.robot_model import RobotModel
from ..observation_form import ObservationForm
from ..world import CAMERAS, SIDES, Frame, Observation, SensorLost, SensorStale
from .world_trial import FRAME_STALE, PERIOD, STALE, WorldTrial

FROZEN = 1.0  # [s] in which a wrench that repeats every bit is dead, as the guard has it
WATCHED = 1.5  # [s]
AHEAD = 1e-3  # [s] by which a stamp may be ahead of the clock


def it_says_what_its_robot_is_made_of(trial: WorldTrial) -> None:
    """Skills plan with that."""
    robot = getattr(trial.world, "robot", None)
    trial.hold(isinstance(robot, RobotModel), f"robot is {robot!r}, but a RobotModel is asked for")


def an_observation_is_whole(trial: WorldTrial) -> None:
    """It has every number, finite and of the right shape, and poses that are poses."""
    seen = trial.world.observe()
    fault = ObservationForm(trial.world.robot).fault(seen)
    trial.hold(not fault, fault)
    for name in (each.name for each in fields(Observation)):
        trial.hold(np.isfinite(getattr(seen, name)).all(), f"{name} holds a number that is not finite")
    trial.hold((seen.gripper_opening >= 0.0).all(), f"gripper_opening is {seen.gripper_opening}, but 0 or more")
    for n, side in enumerate(SIDES):
        trial.hold(_is_pose(seen.pose_hand_in_map[n]), f"pose_hand_in_map of the {side} hand is no pose")


def observations_are_new_and_vary(trial: WorldTrial) -> None:
    """Their time goes on with the clock, and no force sensor repeats itself."""
    before, varied = trial.world.observe(), np.full(2, trial.now())
    ends = trial.now() + WATCHED
    while trial.now() < ends:
        trial.world.clock.wait_until(trial.now() + PERIOD)
        seen, now = trial.world.observe(), trial.now()
        trial.hold(seen.time >= before.time, f"the time of observations went back by {before.time - seen.time:.3f} s")
        trial.hold(seen.time <= now + AHEAD, f"an observation is {seen.time - now:.3f} s ahead of the clock")
        trial.hold(now - seen.time <= STALE, f"an observation is {now - seen.time:.2f} s old")
        new = np.any(seen.wrench_hand_in_map != before.wrench_hand_in_map, axis=1)
        varied[new] = now
        for n, side in enumerate(SIDES):
            still = now - varied[n]
            trial.hold(still <= FROZEN, f"the wrench of the {side} hand has repeated every bit for {still:.1f} s")
        before = seen


def an_observation_stays_as_it_is(trial: WorldTrial) -> None:
    """What was seen does not change with the robot."""
    trial.turn("left", trial.joints[-1], 0.15, 1.0)
    seen = trial.world.observe()
    kept = {field.name: np.array(getattr(seen, field.name)) for field in fields(Observation)}
    trial.let_pass(0.5)
    for name, value in kept.items():
        trial.hold(np.array_equal(value, getattr(seen, name)), f"{name} of an observation changed as the robot moved")
    trial.rest()


def frames_are_whole_new_and_in_place(trial: WorldTrial) -> None:
    """Each has colours and depths of one size, a time with the observation's, and a pose that rests with the robot."""
    trial.rest()
    given = 0
    for camera in CAMERAS:
        try:
            first = trial.world.look(camera)
            trial.let_pass(0.3)
            frame = fresh_frame(trial.world.look(camera), trial.now(), FRAME_STALE)
        except SensorStale as stale:
            trial.hold(False, str(stale))
            continue
        except SensorLost:
            continue  # this robot has no such camera
        given += 1
        _hold_frame(trial, camera, frame)
        trial.hold(frame.stamp >= first.stamp, f"the time of {camera} images went back")
        moved = float(np.abs(frame.pose_camera_in_map - first.pose_camera_in_map).max())
        trial.hold(moved < 0.02, f"the {camera} camera moved by {moved:.2f} while the robot stood still")
        away = abs(frame.stamp - trial.world.observe().time)
        trial.hold(away <= FRAME_STALE, f"the {camera} image is {away:.1f} s apart from the joint state")
    trial.hold(given > 0, f"none of {', '.join(CAMERAS)} gives an image")


def an_unknown_camera_is_lost(trial: WorldTrial) -> None:
    """Asking for one raises SensorLost and nothing else."""
    try:
        trial.world.look("tail")
    except SensorLost:
        return
    except Exception as error:
        trial.hold(False, f"it raised {type(error).__name__}, but SensorLost is asked for")
    trial.hold(False, "there is an image of a camera 'tail'")


def _hold_frame(trial: WorldTrial, camera: str, frame: Frame) -> None:
    trial.hold(frame.camera == camera, f"{camera} was asked for, an image of {frame.camera} came")
    trial.hold(frame.stamp <= trial.now() + AHEAD, f"the {camera} image is ahead of the clock")
    size = np.shape(frame.depth)
    trial.hold(len(size) == 2, f"depth of the {camera} image has shape {size}, but (H, W) is asked for")
    colours = np.shape(frame.rgb) == (*size, 3) and np.asarray(frame.rgb).dtype == np.uint8
    trial.hold(colours, f"rgb of the {camera} image is no (H, W, 3) of uint8 for the depth's {size}")
    depth = np.asarray(frame.depth)
    good = np.isfinite(depth).all() and (depth >= 0.0).all()
    trial.hold(good, f"depth of the {camera} image holds what is no distance; 0 stands for none")
    fx, fy, cx, cy = frame.intrinsics
    inside = fx > 0 and fy > 0 and 0 <= cx <= size[1] and 0 <= cy <= size[0]
    trial.hold(inside, f"intrinsics of the {camera} are {frame.intrinsics} for {size[1]} x {size[0]} pixels")
    trial.hold(_is_pose(frame.pose_camera_in_map), f"pose_camera_in_map of the {camera} is no pose")


def _is_pose(pose: np.ndarray) -> bool:
    turn = np.asarray(pose)[:3, :3]
    right = np.allclose(turn @ turn.T, np.eye(3), atol=1e-4) and np.linalg.det(turn) > 0.0
    return bool(right and np.allclose(pose[3], (0.0, 0.0, 0.0, 1.0)))
