import numpy as np
import pybullet as p
import pytest
from caretree.sim.known_robots import robot_named
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.robot.body import RobotBody
from caretree.sim.world import SIDES, BaseVelocity, GripperOpening, HandTwist, JointTrajectory
from pybullet_utils.bullet_client import BulletClient

DT = 0.0025


class Rig:
    """A robot alone in a deformable world, with a clock."""

    def __init__(self, name):
        self.model = robot_named(name)
        self.client = BulletClient(p.DIRECT)  # whatever other worlds this process has open
        self.client.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
        self.client.setTimeStep(DT)
        self.robot = RobotBody(
            self.client, np.array((1.0, 0.2, 2.5)), head_pan=0.2, kinematics=kinematics_of(self.model)
        )
        self.steps = 0

    def run(self, seconds, before=None):
        """Returns the worst joint error against the targets [deg]."""
        worst = 0.0
        for _ in range(round(seconds / DT)):
            self.robot.update(self.steps * DT)
            if before:
                before()
            self.client.stepSimulation()
            self.steps += 1
            if self.steps % 4 == 0:
                error = self.robot.read().arm_positions.ravel() - self.robot.servo.positions[:-1]
                worst = max(worst, np.rad2deg(np.abs(error).max()))
        return worst


@pytest.fixture(params=["baxter", "ur5-pair"])
def rig(request):
    rig = Rig(request.param)
    yield rig
    rig.client.disconnect()


def test_bullet_and_pinocchio_agree_on_every_link(rig):
    generator = np.random.default_rng(3)
    limits = [rig.robot.kinematics.limits[side] for side in SIDES]
    for _ in range(5):
        arms = np.stack([generator.uniform(limit.lower, limit.upper) for limit in limits])
        base, pan, opening = generator.uniform(-2, 2, 3), generator.uniform(-1, 1), generator.uniform(0, 0.08, 2)
        values = (*base, *arms.ravel(), pan, *np.repeat(opening / 2, 2))
        for joint, value in zip(rig.robot._joints, values, strict=True):
            rig.client.resetJointState(rig.robot.body, joint, value)
        poses = rig.robot.kinematics.link_poses(rig.robot.kinematics.configuration(base, arms, pan, opening))
        for name, link in rig.robot.links.items():
            if link < 0:
                continue
            state = rig.client.getLinkState(rig.robot.body, link, computeForwardKinematics=1)
            rotation = np.array(p.getMatrixFromQuaternion(state[5])).reshape(3, 3)
            np.testing.assert_allclose(state[4], poses[name][:3, 3], atol=1e-6, err_msg=name)
            np.testing.assert_allclose(rotation, poses[name][:3, :3], atol=1e-6, err_msg=name)


def test_motors_hold_and_track_within_half_a_degree(rig):
    start = rig.robot.read().arm_positions.ravel()
    goal = start + 0.3 * np.tile((1, 1, -1, 1, 1, -1, 1)[: rig.model.dof], 2)
    joints = rig.model.commanded_joints[:-1]
    rig.robot.command(JointTrajectory(joints=joints, times=np.array((0.0, 1.5)), positions=np.stack((start, goal))))
    assert rig.run(1.8) < 0.1
    np.testing.assert_allclose(rig.robot.read().arm_positions.ravel(), goal, atol=1e-3)


def test_holding_torque_is_gravity_plus_the_load_on_the_hand(rig):
    rig.run(0.3)
    before = rig.robot.efforts(rig.robot.read())
    gravity = rig.robot.kinematics.gravity_torque(rig.robot.configuration())
    np.testing.assert_allclose(before, gravity, atol=0.15)
    load = np.array((4.0, -3.0, -20.0))
    rig.run(0.3, lambda: rig.robot.apply_hand_forces({"right": load}))
    after = rig.robot.read()
    jacobian = rig.robot.kinematics.jacobian_hand_in_map("right", after.arm_positions[1], after.pose_base_in_map)
    np.testing.assert_allclose((rig.robot.efforts(after) - before)[1], -jacobian[:3].T @ load, atol=0.1)


def test_a_push_on_a_link_is_felt_by_the_joints_before_it_and_no_others(rig):
    rig.run(0.3)
    before = rig.robot.read().motor_torques
    name, joints = {"baxter": ("right_lower_elbow", 4), "ur5-pair": ("right_wrist_1_link", 4)}[rig.model.name]
    link = rig.robot.kinematics.link_poses(rig.robot.configuration())[name]
    rig.run(0.3, lambda: rig.robot.push(name, np.array((0.0, 0.0, -30.0)), link[:3, 3]))
    change = rig.robot.read().motor_torques - before
    assert np.abs(change[1, :joints]).max() > 3.0
    assert np.abs(change[1, joints:]).max() < 0.1
    assert np.abs(change[0]).max() < 0.1


def test_hand_twist_moves_the_hand_straight_and_expires(rig):
    before = rig.robot.pose_hand_in_map("left")
    rig.robot.command(HandTwist(side="left", twist_in_map=np.array((0.05, 0.0, 0.1, 0, 0, 0)), duration=0.6))
    rig.run(1.0)
    after = rig.robot.pose_hand_in_map("left")
    np.testing.assert_allclose(after[:3, 3] - before[:3, 3], (0.03, 0.0, 0.06), atol=2e-3)
    np.testing.assert_allclose(after[:3, :3], before[:3, :3], atol=2e-3)
    assert not rig.robot.servo.moving


def test_base_goes_where_it_is_driven_and_stops_by_itself(rig):
    rig.robot.command(BaseVelocity(velocity=np.array((0.2, 0.1, 0.0)), duration=0.8))
    rig.run(1.5)
    reading = rig.robot.read()
    c, s = np.cos(2.5), np.sin(2.5)
    np.testing.assert_allclose(
        reading.pose_base_in_map, (1.0 + 0.16 * c - 0.08 * s, 0.2 + 0.16 * s + 0.08 * c, 2.5), atol=3e-3
    )
    assert np.abs(reading.twist_base).max() < 1e-3


def test_gripper_closes_and_squeezes_with_the_force_asked_for(rig):
    rig.robot.command(GripperOpening(side="right", opening=0.0, force_limit=12.0))
    rig.run(0.8)
    reading = rig.robot.read()
    np.testing.assert_allclose(reading.gripper_opening, (rig.model.gripper.stroke, 0.0), atol=1e-3)
    np.testing.assert_allclose(reading.gripper_force, (0.0, 12.0), atol=0.5)


def test_stop_ends_every_motion(rig):
    start = rig.robot.read().arm_positions.ravel()
    rig.robot.command(
        JointTrajectory(
            joints=rig.model.commanded_joints[:-1],
            times=np.array((0.0, 2.0)),
            positions=np.stack((start, start + 0.4)),
        )
    )
    rig.robot.command(BaseVelocity(velocity=np.array((0.3, 0.0, 0.2)), duration=5.0))
    rig.run(0.8)
    assert rig.robot.servo.moving
    rig.robot.stop()
    rig.robot.stop()
    rig.run(0.6)
    assert not rig.robot.servo.moving
    assert np.abs(rig.robot.read().arm_velocities).max() < 1e-3


def test_a_hand_that_something_holds_back_presses_with_what_the_motors_may_do_and_moves_on_without_a_jump(rig):
    rig.run(0.2)
    n, start = SIDES.index("right"), rig.robot.pose_hand_in_map("right")[:3, 3]
    fixed = rig.client.createConstraint(
        rig.robot.body, rig.robot.links["right_hand"], -1, -1, p.JOINT_POINT2POINT, (0, 0, 0), (0, 0, 0), start.tolist()
    )
    rig.robot.command(HandTwist(side="right", twist_in_map=np.array((0.0, 0.0, -0.3, 0, 0, 0)), duration=1.0))
    rig.run(1.0)
    force = np.linalg.norm(rig.client.getConstraintState(fixed))
    rig.client.removeConstraint(fixed)
    lead = np.abs(rig.robot.servo.positions[:-1].reshape(2, -1)[n] - rig.robot.read().arm_positions[n]).max()
    rig.run(0.5)
    # a UR5's hand presses with 174 N: motors are bounded joint by joint, which does not bound every hand alike
    most, way = {"baxter": (100.0, 0.08), "ur5-pair": (200.0, 0.10)}[rig.model.name]  # [N], [m] of 0.3 commanded
    assert 10.0 < force < most
    assert lead < 0.08  # [rad]
    assert np.linalg.norm(rig.robot.pose_hand_in_map("right")[:3, 3] - start) < way


def test_what_is_read_holds_until_the_robot_moves_or_is_told_something(rig):
    first = rig.robot.read()
    assert rig.robot.read() is first
    rig.robot.command(BaseVelocity(velocity=np.array((0.2, 0.0, 0.0)), duration=1.0))
    assert rig.robot.read() is not first
    rig.run(0.5)
    assert np.abs(rig.robot.read().pose_base_in_map - first.pose_base_in_map).max() > 0.01
    np.testing.assert_array_equal(rig.robot.efforts(first), rig.robot.efforts(first))
