"""Facts about the gripper, the Robotiq 2F-85: the one place for its sizes, its opening and its force."""

from __future__ import annotations

from dataclasses import dataclass

from ..quantity import Quantities, quantity


@dataclass(frozen=True, kw_only=True)
class GripperFacts(Quantities):
    """What is known of one gripper.  Lengths along the fingers are measured back from the fingertips."""

    stroke: float = quantity(
        0.085, "m", "between the finger pads of the open gripper", "datasheet: Robotiq 2F-85, stroke 85 mm"
    )
    force: tuple[float, float] = quantity(
        (5.0, 235.0), "N", "least and greatest grip force", "datasheet: Robotiq 2F-85, grip force range"
    )
    speed: float = quantity(0.15, "m/s", "between the fingertips, at most", "datasheet: Robotiq 2F-85")
    flange_to_fingertip: float = quantity(
        0.15, "m", "from the flange's face to the fingertips", "datasheet: Robotiq 2F-85, about 0.15 m"
    )
    pad_width: float = quantity(
        0.022, "m", "of a finger and its pad, across the closing direction", "datasheet: Robotiq 2F-85, 22 mm"
    )
    pad_length: float = quantity(
        0.038, "m", "of a finger pad, from the fingertip towards the palm", "design: the pads as they are modelled"
    )
    finger_thickness: float = quantity(
        0.012, "m", "of a finger, along the closing direction", "design: the finger as it is modelled, a box"
    )
    finger_length: float = quantity(0.06, "m", "of a finger", "design: the finger as it is modelled, a box")


GRIPPER = GripperFacts()
