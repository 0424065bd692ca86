"""How large the difficulties of a harder world are, all in one place; names and kinds in `sim/world_kind.py`.

What a difficulty changes is drawn from the seed by a random stream of its own, so that the rest of the scene stays as
it is without it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import radians

import numpy as np

from ..quantity import Quantities, quantity


@dataclass(frozen=True, kw_only=True)
class FallingArms(Quantities):
    """Arms of a grown person who cannot move them: they weigh what arms weigh, and their joints hardly resist."""

    body_mass: tuple[float, float] = quantity(
        (50.0, 90.0),
        "kg",
        "of the person, at least and at most; an arm is 5 % of it, 2.5 to 4.5 kg",
        "paper: Winter, Biomechanics of Human Movement, table 4.1, for the share; choice: adults on a ward",
    )
    shoulder_friction: tuple[float, float] = quantity(
        (0.4, 1.0),
        "N m",
        "of each axis of the shoulder, at least and at most",
        "choice: a tenth of the 7 to 13 N m that gravity has there; Engin and Chen 1986, J Biomech Eng 108:222, "
        "measure passive resistance only beyond the range of voluntary motion",
    )
    elbow_friction: tuple[float, float] = quantity(
        (0.2, 0.6),
        "N m",
        "of the elbow, at least and at most",
        "paper: Wiegner and Watts 1986, JNNP 49:1171: relaxed elbows resist with 0.4 to 1.8 N m/rad, here over a third "
        "of a radian; gravity has 2 to 4 N m there",
    )
    viscous: tuple[float, float] = quantity(
        (0.4, 0.8),
        "N m s/rad",
        "of every joint, at least and at most",
        "choice: a falling arm reaches 2 to 3 m/s at the wrist and does not swing back",
    )
    flexion: tuple[float, float] = quantity(
        (0.0, radians(90.0)),
        "rad",
        "of the elbow at the start, at least and at most",
        "design requirement: 0 to 90 degrees",
    )
    abduction: tuple[float, float] = quantity(
        (radians(10.0), radians(60.0)),
        "rad",
        "of the upper arm from the body at the start, at least and at most",
        "design requirement: 10 to 60 degrees",
    )
    clearance: float = quantity(
        0.02,
        "m",
        "of hand and forearm from the trunk, and of the fingertip from the edge of the bed, at the start, at least",
        "choice: arms have been laid beside the body before a gown is laid on it",
    )
    stiff_share: float = quantity(
        0.15,
        "1",
        "of shoulders that are stiff",
        "choice: now and then; after strokes it is one in four (Front Neurol 2023, 13:1041263, table 2: 59 of 239 with "
        "at most 90 degrees of abduction)",
    )
    stiff_friction: tuple[float, float] = quantity(
        (2.0, 4.0),
        "N m",
        "of each axis of a stiff shoulder, at least and at most",
        "choice: felt by whoever lifts it, and less than the arm's weight",
    )
    stiff_elevation: tuple[float, float] = quantity(
        (radians(30.0), radians(50.0)),
        "rad",
        "off the bed at which a stiff shoulder's range ends, at least and at most",
        "choice: a third to a half of 90 degrees",
    )
    stiff_abduction: tuple[float, float] = quantity(
        (radians(60.0), radians(80.0)),
        "rad",
        "from the body at which a stiff shoulder's range ends, at least and at most",
        "paper: Front Neurol 2023, 13:1041263: severe restriction ends before 90 degrees; above every start",
    )
    end_stiffness: float = quantity(
        20.0,
        "N m/rad",
        "of a stiff shoulder beyond its range",
        "choice: 10 degrees too far resist with 3.5 N m, 7 N at the wrist",
    )
    stirring: float = quantity(
        15.0, "N m", "of the shoulders of a person who stirs", "choice: above what gravity and the bed's friction hold"
    )


@dataclass(frozen=True, kw_only=True)
class CameraExtrinsics(Quantities):
    """Cameras that are not quite where the robot takes them to be; drawn once a run, for each camera."""

    translation: float = quantity(
        0.005, "m", "of each camera, in any direction", "design requirement: 5 mm, as a camera that has been knocked"
    )
    rotation: tuple[float, float] = quantity(
        (radians(0.5), radians(1.0)),
        "rad",
        "of each camera about any axis, at least and at most",
        "design requirement: 0.5 to 1 degree; paper: arXiv 2311.01335 leaves 0.3 degrees after a good calibration",
    )


@dataclass(frozen=True, kw_only=True)
class Localisation(Quantities):
    """A base that knows roughly where it stands: a random walk that turns back at its bounds."""

    position: float = quantity(
        0.02,
        "m",
        "error along x and along y of the map, at most",
        "design requirement: 2 cm; paper: Roewekaemper et al. 2012, IROS: less needs scan matching at taught places",
    )
    turn: float = quantity(radians(1.0), "rad", "error of the heading, at most", "design requirement: 1 degree")
    position_drift: float = quantity(
        0.002, "m/s^0.5", "of the walk along x and along y", "choice: 1 cm in half a minute, so that a stage sees it"
    )
    turn_drift: float = quantity(
        radians(0.1), "rad/s^0.5", "of the walk of the heading", "choice: in the proportion of the bounds"
    )
    period: float = quantity(
        1.0, "s", "between two steps, linear in between", "choice: slower than every motion that is controlled by it"
    )


@dataclass(frozen=True, kw_only=True)
class Encoders(Quantities):
    """Joint sensors whose zero is off; drawn once a run, for each joint of arms and head."""

    offset: float = quantity(
        radians(0.2), "rad", "of a joint's zero, at most", "design requirement: 0.2 degrees, 3.5 mm at 1 m of reach"
    )


@dataclass(frozen=True, kw_only=True)
class LateImages(Quantities):
    """Images that have been on their way for a while; their stamp says since when."""

    age: tuple[float, float] = quantity(
        (0.05, 0.15),
        "s",
        "of an image when it arrives, at least and at most",
        "design requirement: 50 to 150 ms; docs: librealsense rs-latency-tool: tens to hundreds of ms over USB",
    )
    period: float = quantity(
        0.03, "s", "between two images of a camera", "datasheet: consumer RGB-D cameras, 30 images/s"
    )


@dataclass(frozen=True, kw_only=True)
class WrenchBias(Quantities):
    """Force sensors of the wrists that are off, and that do not quite know what they carry; drawn once a run."""

    force: float = quantity(0.5, "N", "of the bias, in any direction of the sensor", "design requirement: 0.5 N")
    torque: float = quantity(0.02, "N m", "of the bias, about any axis of the sensor", "choice: 0.5 N at 4 cm")
    tool_mass: float = quantity(0.9, "kg", "of the gripper", "datasheet: Robotiq 2F-85")
    mass_error: float = quantity(
        0.03, "1", "of the gripper's weight that is taken off wrongly, at most", "choice: cables and a camera, 0.26 N"
    )
    centre_error: float = quantity(
        0.005,
        "m",
        "of the gripper's centre of mass along each axis, at most",
        "choice: what a wrist calibration leaves",
    )
    tilt: float = quantity(
        radians(1.0), "rad", "of the sensor against the hand about each axis, at most", "choice: play of a bolt circle"
    )


@dataclass(frozen=True, kw_only=True)
class DepthNoise(Quantities):
    """What a consumer depth camera adds to the noise of the easy world."""

    step: float = quantity(
        0.00285,
        "1/m",
        "of the depth, times its square",
        "paper: Khoshelham and Oude Elberink 2012, Sensors 12:1437: 2.85 mm at 1 m, 7 cm at 5 m",
    )
    edge: float = quantity(
        0.04, "m", "between neighbours that lie on two surfaces, at least", "choice: half of an arm's thickness"
    )
    flying: float = quantity(
        0.5,
        "1",
        "of the pixels at an edge, which lie anywhere between its sides",
        "choice: an edge runs through every second pixel beside it; paper: arXiv 2410.08084 for what they are",
    )
    edge_dropout: float = quantity(
        0.2, "1", "of the pixels at an edge, which have no depth", "choice: one of the two eyes does not see behind it"
    )
    dropout: float = quantity(
        0.02, "1", "of all pixels, which have no depth", "choice: a good picture of dull surfaces"
    )


@dataclass(frozen=True, kw_only=True)
class ThinkingTime(Quantities):
    """How long the world goes on while the robot thinks, at least and at most."""

    image: tuple[float, float] = quantity(
        (0.01, 0.05),
        "s",
        "for each image",
        "measured: 5 to 11 ms here for arm, head or sleeve; choice: several of them",
    )
    plan: tuple[float, float] = quantity(
        (0.1, 0.5),
        "s",
        "for each trajectory of the arms",
        "choice: a thousand collision checks of 0.1 to 0.3 ms, and its timing",
    )


@dataclass(frozen=True, kw_only=True)
class SkinFriction(Quantities):
    """Skin on which cloth does not slide as easily as in the easy world, where the coefficient is 0.2."""

    coefficient: tuple[float, float] = quantity(
        (0.3, 0.6),
        "1",
        "of Coulomb friction between gown and skin, at least and at most",
        "design requirement: 0.3 to 0.6",
    )


@dataclass(frozen=True, kw_only=True)
class Sizes(Quantities):
    """How large each difficulty is; a difficulty has the name of its field."""

    falling_arms: FallingArms = field(default_factory=FallingArms)
    camera_extrinsics: CameraExtrinsics = field(default_factory=CameraExtrinsics)
    localisation: Localisation = field(default_factory=Localisation)
    encoders: Encoders = field(default_factory=Encoders)
    late_images: LateImages = field(default_factory=LateImages)
    wrench_bias: WrenchBias = field(default_factory=WrenchBias)
    depth_noise: DepthNoise = field(default_factory=DepthNoise)
    thinking_time: ThinkingTime = field(default_factory=ThinkingTime)
    skin_friction: SkinFriction = field(default_factory=SkinFriction)


SIZES = Sizes()


def stream(seed: int, difficulty: str) -> np.random.Generator:
    """The random numbers from which one difficulty is drawn; they shift no other draw."""
    return np.random.default_rng([seed, *difficulty.encode()])
