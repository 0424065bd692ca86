"""A pendulum in MuJoCo: the motor's torque is commanded, the hinge's angle is measured (`pip install mujoco`).

Everything below is what a user writes: the model they already have, and what may be missing in it.
"""

import mujoco
import numpy as np

from caretree.gap import Effect, Parameter, System

MODEL = """<mujoco><option timestep="0.01" integrator="RK4"/>
<worldbody><body name="rod"><joint name="hinge" type="hinge" axis="0 1 0"/>
  <geom type="capsule" fromto="0 0 0 0 0 -0.5" size="0.02" mass="1.0"/>
  <body name="tip" pos="0 0 -0.5"><inertial pos="0 0 0" mass="0.1" diaginertia="1e-5 1e-5 1e-5"/></body>
</body></worldbody>
<actuator><motor name="motor" joint="hinge"/></actuator></mujoco>"""


def hinge(name: str, number: str, unit: str, typical: float) -> Effect:
    parameter = Parameter(name=f"hinge_{number}", unit=unit, typical=typical, lower=0.0)
    return Effect(name=name, target="hinge", exports=number, parameters=(parameter,))


class Pendulum(System):
    name = "pendulum"
    channels = {"q": "rad"}
    inputs = {"torque": "N m"}
    effects = (
        hinge("viscous_friction", "damping", "N m s/rad", 0.02),
        hinge("dry_friction", "friction", "N m", 0.05),
        hinge("armature", "armature", "kg m^2", 0.01),
        Effect(name="payload", target="tip", exports="mass",
               parameters=(Parameter(name="payload", unit="kg", typical=0.05, lower=-0.09),)),
        Effect(name="motor_gain", target="motor", recalibration=True,
               parameters=(Parameter(name="gain", unit="1", typical=0.05, lower=-0.9),)),
    )  # fmt: skip
    start = (
        Parameter(name="q0", unit="rad", typical=0.01, lower=-0.05, upper=0.05),  # the encoder's noise
        Parameter(name="dq0", unit="rad/s", typical=0.05, lower=-0.2, upper=0.2),  # nearly at rest
    )

    def __init__(self):
        self.model = mujoco.MjModel.from_xml_string(MODEL)
        self.tip = float(self.model.body("tip").mass[0])

    def predict(self, log, values):
        m = self.model
        m.dof_damping[0], m.dof_frictionloss[0] = values["hinge_damping"], values["hinge_friction"]
        m.dof_armature[0], m.body("tip").mass[0] = values["hinge_armature"], self.tip + values["payload"]
        d = mujoco.MjData(m)
        mujoco.mj_setConst(m, d)
        d.qpos[0], d.qvel[0] = log["q"][0] + values["q0"], values["dq0"]
        q = np.empty(len(log["t"]))
        for i, t in enumerate(log["t"] - log["t"][0]):
            while d.time < t - 1e-9:
                d.ctrl[0] = (1.0 + values["gain"]) * log["torque"][i - 1]
                mujoco.mj_step(m, d)
            q[i] = d.qpos[0]
        return q
