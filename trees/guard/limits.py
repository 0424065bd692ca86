"""Safety limits as data, each with its source.  Nothing else in the project repeats these numbers."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from ...sim.errors import CaretreeError


@dataclass(frozen=True, kw_only=True)
class Limits:
    """What the guard enforces.  SI units.

    Attributes:
        hand_speed: of a hand near the person [m/s].
        near_person: closer than this counts as near [m].
        person_above_bed: until the person has been seen, the bed and this much above it count as the person [m].
        hand_speed_commanded: fraction of `hand_speed` that commands may ask for.
        cloth_load_slow: twists that pull against the cloth are scaled down from here [N].
        cloth_load_stop: motion stops and only relieving motion passes from here on [N].
        cloth_load_rearm: the stop is armed again below this [N].
        arm_load_stop: the same stop while the hand holds the person's arm [N], once it has lasted for `arm_load_for`.
        arm_load_peak: load on such a hand that stops it at once [N].
        arm_load_for: how long a held arm may pull harder than `arm_load_stop` [s].
        grip_force_arm: squeezing force on the person's arm [N].
        velocity_for: a velocity of a hand or the base is held no longer than this; its end alone is judged [s].
        plan_start: a trajectory begins no farther than this from where the arm is, each joint [rad].
        lift_duration: an arm lift lasts at least this long [s].
        lift_height: the lift that `lift_duration` is meant for; their ratio caps the hand's speed [m].
        stale_after: proprioception older than this stops the run [s].
        frozen_after: a wrench that repeats bit by bit for this long is dead and stops the run [s].
        frame_stale_after: an image older than this fails the skill that asked [s].
        frozen_frames: this many images in a row without any change in depth fail the skill that asked.
        still_joint_speed: an arm slower than this stands still [rad/s].
        still_base_speed: a base slower than this stands still [m/s or rad/s].
        overspeed_for: measured speed above the limit for this long fails the skill [s].
        overspeed_factor: measured speed counts as above the limit from this multiple on.
        stop_patience: a motion that does not stop within this time is stuck [s].
        safe_branch: the fail-safe branch may take this long before the runner stops everything itself [s].
        run: no run lasts longer [s].
        tick: one tick lasts no longer, by the wall clock [s].
        late_tick: without a tick or a new sample for so long the robot is stopped, by the wall clock [s].
        wait: a world whose time passes by itself is waited for no longer, by the wall clock [s].
    """

    hand_speed: float = 0.15
    near_person: float = 0.30
    person_above_bed: float = 0.35
    hand_speed_commanded: float = 0.9
    cloth_load_slow: float = 8.0
    cloth_load_stop: float = 18.0
    cloth_load_rearm: float = 14.0
    arm_load_stop: float = 30.0
    arm_load_peak: float = 45.0
    arm_load_for: float = 0.4
    grip_force_arm: float = 30.0
    velocity_for: float = 1.0
    plan_start: float = 0.05
    lift_duration: float = 5.0
    lift_height: float = 0.25
    stale_after: float = 0.5
    frozen_after: float = 1.0
    frame_stale_after: float = 1.0
    frozen_frames: int = 5
    still_joint_speed: float = 0.02
    still_base_speed: float = 0.01
    overspeed_for: float = 0.3
    overspeed_factor: float = 1.5
    stop_patience: float = 5.0
    safe_branch: float = 60.0
    run: float = 1800.0
    tick: float = 120.0
    late_tick: float = 0.3
    wait: float = 5.0

    def __post_init__(self) -> None:
        """Reject limits that contradict each other."""
        for name, value in asdict(self).items():
            if not value > 0:
                raise CaretreeError(f"limit {name} is {value}, but limits are above zero")
        if not self.cloth_load_slow < self.cloth_load_stop:
            raise CaretreeError(
                f"cloth_load_slow is {self.cloth_load_slow} N, but must be below "
                f"cloth_load_stop, {self.cloth_load_stop} N"
            )
        if not self.arm_load_stop <= self.arm_load_peak:
            raise CaretreeError(
                f"arm_load_stop is {self.arm_load_stop} N, but must not be above arm_load_peak, {self.arm_load_peak} N"
            )
        if not self.cloth_load_rearm < self.cloth_load_stop:
            raise CaretreeError(
                f"cloth_load_rearm is {self.cloth_load_rearm} N, but must be below "
                f"cloth_load_stop, {self.cloth_load_stop} N"
            )

    @property
    def lift_speed(self) -> float:
        """Speed of a hand that holds the person's arm [m/s]."""
        return self.lift_height / self.lift_duration


SOURCES: dict[str, str] = {
    "hand_speed": "design requirement: 0.15 m/s within 0.3 m of the person",
    "near_person": "design requirement: 0.15 m/s within 0.3 m of the person",
    "person_above_bed": "choice: chest of a lying person with an arm across it",
    "hand_speed_commanded": "choice: room for the overshoot of a tracking controller",
    "cloth_load_slow": "design requirement: slow down from 8 N",
    "cloth_load_stop": "design requirement: stop and back off at 18 N",
    "cloth_load_rearm": "choice: hysteresis, so that one excess counts once",
    "arm_load_stop": "choice: no more pull on a held arm than the grip itself may apply",
    "arm_load_peak": "choice: the friction of the grip on the arm gives way soon after",
    "arm_load_for": "choice: with dry friction in its joints a held arm shifts 10 N from one tick to the next",
    "grip_force_arm": "design requirement: at most 30 N of grip on an arm",
    "velocity_for": "choice: skills send again on every tick; in 1 s nothing passes through an arm unseen",
    "plan_start": "choice: five times what MoveIt allows at the start; plans of the dressing begin within 0.0001",
    "lift_duration": "design requirement: an arm is lifted for at least 5 s",
    "lift_height": "choice: wrist of a resting arm to the height at which a sleeve passes under it",
    "stale_after": "choice: seven ticks at 15 Hz",
    "frozen_after": "choice: no real force sensor repeats every bit for 15 ticks",
    "frame_stale_after": "choice: a camera at 5 Hz misses five frames",
    "frozen_frames": "choice: depth noise changes every real image",
    "still_joint_speed": "choice: 2 cm/s at 1 m of reach, what a loaded arm still trembles",
    "still_base_speed": "choice: below the noise of wheel odometry",
    "overspeed_for": "choice: shorter peaks are vibration of the arm",
    "overspeed_factor": "choice: above the noise of a speed differentiated at 15 Hz",
    "stop_patience": "choice: longer than the slowest controlled stop of the arm",
    "safe_branch": "choice: release, back off and a 5 s lowering of each arm, three times over",
    "run": "choice: six times the longest run expected",
    "late_tick": "choice: four ticks at 15 Hz, which leaves 0.2 s of half a second to brake in",
    "wait": "choice: fifty times what the contract of a clock allows",
    "tick": "choice: six times the longest plan, for a machine that has much else to do",
}

DEFAULT = Limits()
