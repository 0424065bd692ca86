"""Facts about a person's body that perception assumes before it sees one: the one place for its sizes."""

from __future__ import annotations

from dataclasses import dataclass

from ...sim.quantity import Quantities, quantity

_WINTER = "paper: Winter, Biomechanics of Human Movement, fig. 4.1, shares of body height"


@dataclass(frozen=True, kw_only=True)
class PersonFacts(Quantities):
    """An adult of 174 cm who lies on the back; other adults are this one times a scale."""

    arm_lengths: tuple[float, float, float] = quantity(
        (0.28, 0.25, 0.175), "m", "of upper arm, forearm and hand", "choice: an adult of 174 cm"
    )
    length_variation: float = quantity(
        0.06, "1", "of these lengths among adults of one height, standard deviation", "choice: of the order of 1 cm"
    )
    arm_radii: tuple[float, float, float] = quantity(
        (0.041, 0.036, 0.030), "m", "of upper arm, forearm and hand", "choice: an adult of 174 cm"
    )
    shortest_span: float = quantity(
        0.30,
        "m",
        "from shoulder to wrist of an arm as far bent as an arm at rest bends",
        "choice: an elbow at 111 degrees, more than an arm at rest bends",
    )
    span_deviation: float = quantity(
        0.015,
        "m",
        "of the distance from shoulder to wrist over time",
        "choice: friction holds an elbow that its owner cannot move, in a straight arm to an angle of 30 degrees",
    )
    crown_to_shoulder: float = quantity(0.31, "m", "along the body", _WINTER)
    shoulders_headward: float = quantity(
        0.55, "m", "of the shoulders from the middle of the bed", "choice: with the head on a pillow"
    )
    head_radius: float = quantity(0.10, "m", "of head and neck, with hair", "choice: an adult's")
    neck_length: float = quantity(
        0.08,
        "m",
        "of the end of the neck's axis from the shoulders, towards the head",
        "choice: its front, as round as the head, ends 2 cm footward of them, at the notch of the breastbone",
    )
    shoulder_half_width: float = quantity(0.20, "m", "from the midline to the shoulder joint", _WINTER)
    trunk_half_width: float = quantity(0.20, "m", "from the midline to the flank", _WINTER)
    head_height: float = quantity(
        0.180,
        "m",
        "of the middle of what is seen of a lying head, above the mattress",
        "measured: on two manikins of 174 cm, 0.178 and 0.183",
    )
    shoulder_height: float = quantity(0.10, "m", "of the shoulder joint above the mattress", _WINTER)
    flank_height: float = quantity(
        0.20, "m", "of the trunk above the mattress, as far as its flanks are steep", "choice: below its front"
    )
    front_height: float = quantity(
        0.22, "m", "of the front of the trunk above the mattress", "choice: an adult's chest lying on the back"
    )
    trunk_range: tuple[float, float] = quantity(
        (-0.05, 0.60), "m", "of the trunk's flanks along the body from the shoulders", "choice: armpit to hip, rounded"
    )
    trunk_length: float = quantity(0.55, "m", "from the shoulders to the hips", "choice: an adult of 174 cm")
    leg_length: float = quantity(0.85, "m", "from the hips to the feet", "choice: an adult of 174 cm")
    thigh_half_width: float = quantity(
        0.185,
        "m",
        "from the midline to the outside of legs that lie flat and spread a little",
        "choice: between hips that stand and that sit; at 0.17 m a hand met the outside of a thigh with 296 N (166)",
    )
    leg_radius: float = quantity(0.08, "m", "of legs that lie flat", "choice: an adult of 174 cm")
    axis_height: float = quantity(
        0.11, "m", "of the body's axis above the mattress", "choice: half the depth of a trunk that lies on its back"
    )
    head_radius_range: tuple[float, float] = quantity(
        (0.06, 0.13), "m", "of heads as round bodies", "choice: children's to large ones"
    )
    head_width_range: tuple[float, float] = quantity(
        (0.08, 0.30), "m", "of what shows of a head", "choice: half a head, and a head with an ear's margin"
    )
    head_top_range: tuple[float, float] = quantity(
        (0.10, 0.35), "m", "of the highest part of a lying head above the mattress", "choice: with and without a pillow"
    )
    scale_range: tuple[float, float] = quantity(
        (0.85, 1.15), "1", "of bodies relative to 174 cm", "choice: adults of 148 to 200 cm"
    )


PERSON = PersonFacts()
