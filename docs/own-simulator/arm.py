"""An arm of two joints in MuJoCo under its own position control: joint angles are commanded and measured.

Everything below is what a user writes.  Effects are rows of a table, each a number of MuJoCo's model.
"""

import mujoco
import numpy as np

from caretree.gap import Effect, Parameter, System

MODEL = """<mujoco><option timestep="0.005" integrator="RK4"/>
<worldbody><body name="upper"><joint name="shoulder" type="hinge" axis="0 1 0"/>
  <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.03" mass="1.5"/>
  <body name="fore" pos="0.3 0 0"><joint name="elbow" type="hinge" axis="0 1 0"/>
    <geom type="capsule" fromto="0 0 0 0.25 0 0" size="0.02" mass="0.8"/>
    <body name="hand" pos="0.25 0 0"><inertial pos="0 0 0" mass="0.1" diaginertia="1e-5 1e-5 1e-5"/></body>
</body></body></worldbody>
<actuator><position joint="shoulder" kp="60" kv="4"/><position joint="elbow" kp="30" kv="1.5"/></actuator></mujoco>"""
JOINTS = ("shoulder", "elbow")
ROWS = [  # effect, number of a robot file, unit, typical size
    ("viscous_friction", "damping", "N m s/rad", 0.2),
    ("dry_friction", "friction", "N m", 0.2),
    ("armature", "armature", "kg m^2", 0.02),
]


def on(joint: str, name: str, number: str, unit: str, typical: float) -> Effect:
    parameter = Parameter(name=f"{joint}_{number}", unit=unit, typical=typical, lower=0.0)
    return Effect(name=name, target=joint, exports=number, parameters=(parameter,))


class Arm(System):
    name = "two_joints"
    channels = {"q1": "rad", "q2": "rad"}
    inputs = {"c1": "rad", "c2": "rad"}
    effects = (
        *(on(joint, *row) for joint in JOINTS for row in ROWS),
        Effect(name="payload", target="hand", exports="mass",
               parameters=(Parameter(name="mass", unit="kg", typical=0.1, lower=-0.09),)),
    )  # fmt: skip

    def __init__(self):
        self.model = mujoco.MjModel.from_xml_string(MODEL)
        self.hand = float(self.model.body("hand").mass[0])

    def predict(self, log, values):
        m, commands = self.model, np.stack([log["c1"], log["c2"]], axis=1)
        m.dof_damping[:] = [values[f"{j}_damping"] for j in JOINTS]
        m.dof_frictionloss[:] = [values[f"{j}_friction"] for j in JOINTS]
        m.dof_armature[:] = [values[f"{j}_armature"] for j in JOINTS]
        m.body("hand").mass[0] = self.hand + values["mass"]
        d = mujoco.MjData(m)
        mujoco.mj_setConst(m, d)
        d.qpos[:], out = (log["q1"][0], log["q2"][0]), np.empty_like(commands)
        for i, t in enumerate(log["t"] - log["t"][0]):
            while d.time < t - 1e-9:
                d.ctrl[:] = commands[i - 1]
                mujoco.mj_step(m, d)
            out[i] = d.qpos
        return out
