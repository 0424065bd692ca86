"""A record of a run, made by hand: a hand waits over the right elbow, closes, lifts the arm, and holds it."""

import json
from types import SimpleNamespace

import numpy as np
from caretree.sim.mechanics.kinematics import kinematics_of
from caretree.sim.record.measured import MeasuredLog
from caretree.sim.robot.baxter import BAXTER
from caretree.sim.robot.model import READY
from caretree.sim.scene.scene import room_map
from scipy.spatial.transform import Rotation

RATE = 15.0
WAIT, CLOSE, LIFT, HOLD = 1.0, 0.2, 1.6, 0.8  # [s]
HEIGHT = 0.08  # [m]


def hand_path(elbow, along, wait=WAIT):
    """Times (T,), poses (T, 4, 4) of a hand from above that holds an arm which points along `along`, openings (T,)."""
    t = np.arange(0.0, wait + CLOSE + LIFT + HOLD, 1.0 / RATE) + 5.0
    share = np.clip((t - 5.0 - wait - CLOSE) / LIFT, 0.0, 1.0)
    poses = np.tile(np.eye(4), (len(t), 1, 1))
    across = np.array((-along[1], along[0], 0.0)) / np.hypot(*along[:2])
    down = np.array((0.0, 0.0, -1.0))
    poses[:, :3, :3] = np.column_stack((np.cross(across, down), across, down))
    poses[:, :3, 3] = elbow + np.outer(HEIGHT * (3.0 - 2.0 * share) * share**2, (0.0, 0.0, 1.0))
    opening = np.interp(t, (5.0 + wait, 5.0 + wait + CLOSE), (0.085, 0.0735))
    return t, poses, opening


def joints_for(poses, base):
    """(T, 7) joint angles of the left arm for hand poses, by damped least squares from starts drawn at random."""
    rng = np.random.default_rng(0)
    starts = (_joints(poses[0], base, READY[0] + rng.normal(size=7) * 0.5, 100) for _ in range(100))
    out = [next(joints for joints in starts if joints is not None)]
    for pose in poses[1:]:
        out.append(_joints(pose, base, out[-1], 30))
    return np.array(out)


def _joints(pose, base, q, rounds):
    kinematics = kinematics_of(BAXTER)
    for _ in range(rounds):
        now = kinematics.pose_hand_in_map("left", q, base)
        turn = Rotation.from_matrix(pose[:3, :3] @ now[:3, :3].T).as_rotvec()
        off = np.concatenate((pose[:3, 3] - now[:3, 3], turn))
        if np.abs(off).max() < 1e-5:
            return q
        jacobian = kinematics.jacobian_hand_in_map("left", q, base)
        step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + 1e-5 * np.eye(6), off)
        q = q + np.clip(step, -0.2, 0.2)
    return None


def write_record(folder, arms, seed=100, load=None, wait=WAIT):
    """Write run.json, truth.npz and measured.npz of the lift; `load` (T, 3) is what the left hand felt [N]."""
    upper = arms[1, 1] - arms[1, 0]
    t, poses, opening = hand_path(
        arms[1, 1] - 0.01 * upper / np.linalg.norm(upper), upper / np.linalg.norm(upper), wait
    )
    base = np.array(room_map().waypoints["bed_right"])
    left = joints_for(poses, base)
    right = kinematics_of(BAXTER).pose_hand_in_map("right", READY[1], base)
    log = MeasuredLog()
    for k, time in enumerate(t):
        wrench = np.zeros((2, 6))
        wrench[0, :3] = 0.0 if load is None else load[k]
        log.sample(
            SimpleNamespace(
                time=time,
                pose_hand_in_map=np.stack((poses[k], right)),
                wrench_hand_in_map=wrench,
                gripper_opening=np.array((opening[k], 0.085)),
                arm_positions=np.stack((left[k], READY[1])),
                head_pan=0.0,
                pose_base_in_map=base,
            )
        )
    log.arm(float(t[0]), "right", arms[1])
    folder.mkdir(exist_ok=True)
    log.write(folder)
    run = {"task": "lift", "seed": seed, "world": "bullet", "outcome": "success", "parameters": {"world_kind": "easy"}}
    (folder / "run.json").write_text(json.dumps(run))
    held = np.full((len(t), 2), -1)
    held[t >= 5.0 + wait + CLOSE, 0] = 1
    force = np.zeros((len(t), 9))
    force[held[:, 0] >= 0, 4] = 10.0
    np.savez(
        folder / "truth.npz",
        t=t,
        arms=np.tile(arms, (len(t), 1, 1, 1)),
        holds_arm=held,
        gripper_closed=np.zeros((len(t), 2), bool),
        person_force=force,
        vertices=np.zeros((len(t), 0, 3)),
    )
    return folder
