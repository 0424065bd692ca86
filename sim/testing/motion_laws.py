"""Laws of what a world does.  Its robot moves by some centimetres: it needs 0.3 m of room around it."""

from __future__ import annotations

import threading

import numpy as np

from ..world import SIDES, BaseVelocity, GripperOpening, HandTwist, JointTrajectory, WorldError
from .world_trial import STOPPED_WITHIN, WorldTrial, is_still, joint_motion

REACHED = 0.03  # [rad] from the end of a trajectory
ASIDE = 0.02  # [rad] that other joints may move
SETTLE = 0.6  # [s] after the end of a motion
TURN = 0.15  # [rad]
HELD = 0.02  # [rad], [m] that may still move after a stop
OPENING_ERROR = 0.006  # [m]
STOPPABLE = 0.06  # [rad], [m] that may move where a stop follows a command at once


def a_trajectory_ends_where_it_should(trial: WorldTrial) -> None:
    """The joint that was named is half way at half time and there at the end, and no other joint moves."""
    for side in SIDES:
        for joint in (trial.joints[-1], trial.joints[0]):
            start = trial.rest().arm_positions
            n, k = SIDES.index(side), trial.joints.index(joint)
            sent = trial.turn(side, joint, TURN, 1.2)
            goal, lasts = float(sent.positions[-1, 0]), float(sent.times[-1])
            middle = trial.let_pass(0.5 * lasts)[-1]
            share = (middle.arm_positions[n, k] - start[n, k]) / (goal - start[n, k])
            end = trial.let_pass(0.5 * lasts + SETTLE)[-1]
            name, off = f"{side}_{joint}", abs(end.arm_positions[n, k] - goal)
            trial.hold(off < REACHED, f"{name} ended {off:.3f} rad from where it was sent")
            trial.hold(0.15 < share < 0.85, f"{name} had come {share:.0%} of its way after half of its time")
            speed = middle.arm_velocities[n, k] * np.sign(goal - start[n, k])
            trial.hold(speed > 0.2 * TURN / lasts, f"the velocity of {name} was {speed:.3f} rad/s on its way")
            moved = np.abs(end.arm_positions - start)
            moved[n, k] = 0.0
            trial.hold(moved.max() < ASIDE, f"another joint than {name} moved by {moved.max():.3f} rad")
            trial.hold(is_still(end), f"the robot still moves {SETTLE:g} s after the end of a trajectory")


def a_joint_that_the_robot_does_not_have_is_refused(trial: WorldTrial) -> None:
    """In one sentence, before anything moves."""
    try:
        trial.world.send(joint_motion("third_elbow", 0.0, TURN, 1.0))
    except WorldError:
        return
    except Exception as error:
        trial.hold(False, f"it raised {type(error).__name__}, but WorldError is asked for")
    trial.hold(False, "a trajectory of a joint 'third_elbow' was taken")


def the_head_turns_as_it_is_told(trial: WorldTrial) -> None:
    """Its joint is one like the others."""
    start = trial.rest().head_pan
    sent = trial.send(joint_motion(trial.world.robot.head_joint, start, start + TURN, 1.2))
    assert isinstance(sent, JointTrajectory)
    off = abs(trial.let_pass(float(sent.times[-1]) + SETTLE)[-1].head_pan - float(sent.positions[-1, 0]))
    trial.hold(off < REACHED, f"it ended {off:.3f} rad from where it was sent")


def what_was_really_sent_comes_back(trial: WorldTrial) -> None:
    """What is clipped comes back clipped: the robot does what came back, or refuses in one sentence."""
    for side in SIDES:
        try:
            sent = trial.send(GripperOpening(side=side, opening=0.5))
        except WorldError:
            continue
        assert isinstance(sent, GripperOpening)
        opened = float(trial.let_pass(2.0)[-1].gripper_opening[SIDES.index(side)])
        off = abs(opened - sent.opening)
        said = f"{sent.opening:.3f} m came back for the {side} fingers, which stand {opened:.3f} m apart"
        trial.hold(off < OPENING_ERROR, said)
    start = float(trial.rest().arm_positions[0, -1])
    try:
        quick = trial.send(joint_motion(f"left_{trial.joints[-1]}", start, start - TURN, 0.02))
    except WorldError:
        return
    assert isinstance(quick, JointTrajectory)
    end = trial.let_pass(float(quick.times[-1]) + SETTLE)[-1].arm_positions[0, -1]
    off = abs(end - float(quick.positions[-1, 0]))
    trial.hold(off < REACHED, f"a quick motion ended {off:.3f} rad from what came back")


def a_twist_lasts_its_duration(trial: WorldTrial) -> None:
    """The hand moves along the axes of the map, as far as speed and duration say, and no further."""
    for side in SIDES:
        for axis in (2, 0):
            n, way = SIDES.index(side), np.eye(6)[axis]
            start = trial.rest().pose_hand_in_map[n, :3, 3]
            sent = trial.send(HandTwist(side=side, twist_in_map=0.06 * way, duration=0.5))
            assert isinstance(sent, HandTwist)
            asked = float(sent.twist_in_map[axis]) * sent.duration
            seen = trial.let_pass(sent.duration + SETTLE)[-1]
            moved = seen.pose_hand_in_map[n, :3, 3] - start
            along, aside = float(moved[axis]), float(np.linalg.norm(np.delete(moved, axis)))
            what = f"the {side} hand, sent {asked:.3f} m along {'xyz'[axis]} of the map,"
            trial.hold(abs(along - asked) < 0.4 * asked + 0.004, f"{what} moved {along:.3f} m")
            trial.hold(aside < 0.012, f"{what} moved {aside:.3f} m aside")
            after = trial.let_pass(0.5)[-1].pose_hand_in_map[n, :3, 3]
            on = float(np.linalg.norm(after - seen.pose_hand_in_map[n, :3, 3]))
            trial.hold(on < 0.004, f"{what} went on by {on:.3f} m after its time")


def the_base_drives_for_its_duration(trial: WorldTrial) -> None:
    """It drives along its own axes, as far as speed and duration say, and no further."""
    x, y, yaw = trial.rest().pose_base_in_map
    sent = trial.send(BaseVelocity(velocity=np.array((-0.1, 0.0, 0.0)), duration=0.6))
    assert isinstance(sent, BaseVelocity)
    asked = float(sent.velocity[0]) * sent.duration
    seen = trial.let_pass(sent.duration + SETTLE)[-1].pose_base_in_map
    ahead = float((seen[0] - x) * np.cos(yaw) + (seen[1] - y) * np.sin(yaw))
    aside = abs(float((seen[1] - y) * np.cos(yaw) - (seen[0] - x) * np.sin(yaw)))
    off = abs(ahead - asked)
    trial.hold(off < 0.4 * abs(asked) + 0.01, f"sent {asked:.3f} m ahead it drove {ahead:.3f} m")
    trial.hold(aside < 0.02, f"sent straight ahead it drove {aside:.3f} m aside")
    on = float(np.abs(trial.let_pass(0.5)[-1].pose_base_in_map - seen).max())
    trial.hold(on < 0.01, f"it went on by {on:.3f} m after its time")


def a_new_command_replaces_the_old_one(trial: WorldTrial) -> None:
    """Of the same joints; the other arm goes on."""
    joint, start = trial.joints[-1], trial.rest().arm_positions
    trial.turn("left", joint, 2.0 * TURN, 2.0)
    other = trial.turn("right", joint, TURN, 2.0)
    here = float(trial.let_pass(0.6)[-1].arm_positions[0, -1])
    back = trial.send(joint_motion(f"left_{joint}", here, float(start[0, -1]), 1.0))
    assert isinstance(back, JointTrajectory)
    end = trial.let_pass(2.0 + SETTLE)[-1].arm_positions[:, -1]
    off = np.abs(end - (back.positions[-1, 0], other.positions[-1, 0]))
    trial.hold(off[0] < REACHED, f"left_{joint} ended {off[0]:.3f} rad from where it was sent last")
    trial.hold(off[1] < REACHED, f"right_{joint} ended {off[1]:.3f} rad off, as the left arm was sent elsewhere")


def stopping_ends_every_motion(trial: WorldTrial) -> None:
    """In the middle of motions, twice, and where nothing moves; the robot then stays where it is."""
    trial.turn("left", trial.joints[-1], 2.0 * TURN, 3.0)
    trial.send(HandTwist(side="right", twist_in_map=0.03 * np.eye(6)[2], duration=3.0))
    trial.send(BaseVelocity(velocity=np.array((-0.04, 0.0, 0.0)), duration=3.0))
    trial.let_pass(0.5)
    _stop(trial, times=2)
    trial.let_pass(STOPPED_WITHIN)
    before = trial.observe()
    trial.hold(is_still(before), f"something still moves {STOPPED_WITHIN:g} s after stop()")
    _stop(trial, times=1)
    after = trial.let_pass(1.5)[-1]
    moved = np.abs(after.arm_positions - before.arm_positions).max()
    moved = max(moved, np.abs(after.pose_base_in_map - before.pose_base_in_map).max())
    trial.hold(moved < HELD, f"it moved by {moved:.3f} after it had been stopped")


def stopping_right_after_a_command_ends_it(trial: WorldTrial) -> None:
    """A command that is still on its way is stopped too."""
    start = trial.rest()
    trial.turn("left", trial.joints[-1], 2.0 * TURN, 1.0)
    _stop(trial, times=1)
    end = trial.let_pass(1.5)[-1]
    moved = np.abs(end.arm_positions - start.arm_positions).max()
    trial.hold(moved < STOPPABLE, f"a trajectory that was stopped at once moved {moved:.3f} rad")
    trial.send(BaseVelocity(velocity=np.array((-0.15, 0.0, 0.0)), duration=1.0))
    _stop(trial, times=1)
    drove = np.abs(trial.let_pass(1.5)[-1].pose_base_in_map - end.pose_base_in_map).max()
    trial.hold(drove < STOPPABLE, f"a base that was stopped at once drove {drove:.3f} m")


def stopping_works_from_another_thread(trial: WorldTrial) -> None:
    """As the watchdog does it."""
    errors: list[BaseException] = []

    def stop() -> None:
        try:
            trial.world.stop()
        except BaseException as error:
            errors.append(error)

    trial.turn("left", trial.joints[-1], 2.0 * TURN, 3.0)
    trial.let_pass(0.4)
    thread = threading.Thread(target=stop, daemon=True)
    thread.start()
    thread.join(5.0)
    trial.hold(not thread.is_alive(), "it does not come back")
    trial.hold(not errors, f"it raised {errors[0]!r}" if errors else "")
    trial.let_pass(STOPPED_WITHIN)
    trial.hold(is_still(trial.observe()), f"something still moves {STOPPED_WITHIN:g} s afterwards")


def fingers_go_where_they_are_sent_and_stay(trial: WorldTrial) -> None:
    """Empty fingers close and open; a stop of the robot leaves them as they are."""
    for side in SIDES:
        n = SIDES.index(side)
        other = float(trial.observe().gripper_opening[1 - n])
        for opening in (0.02, 0.05):
            sent = trial.send(GripperOpening(side=side, opening=opening))
            assert isinstance(sent, GripperOpening)
            seen = trial.let_pass(2.0)[-1].gripper_opening
            said = f"the {side} fingers were sent to {sent.opening:.3f} m and stand {seen[n]:.3f} m apart"
            trial.hold(abs(seen[n] - sent.opening) < OPENING_ERROR, said)
            _stop(trial, times=1)
            stays = float(trial.let_pass(0.5)[-1].gripper_opening[n])
            trial.hold(abs(stays - seen[n]) < OPENING_ERROR, f"stop() moved the {side} fingers to {stays:.3f} m")
        moved = abs(float(trial.observe().gripper_opening[1 - n]) - other)
        trial.hold(moved < OPENING_ERROR, f"the other fingers than the {side} ones moved by {moved:.3f} m")


def closing_twice_is_closing_once(trial: WorldTrial) -> None:
    """What is released stays released."""
    for _ in range(2):
        try:
            trial.world.close()
        except Exception as error:
            trial.hold(False, f"it raised {type(error).__name__}: {error}")


def _stop(trial: WorldTrial, *, times: int) -> None:
    for _ in range(times):
        try:
            trial.world.stop()
        except Exception as error:
            trial.hold(False, f"stop() raised {type(error).__name__}: {error}")
