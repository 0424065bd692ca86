"""Bounds of a dressed, unharmed person and of a believable simulation, each with its reason."""

HOLD = 2.0  # [s] both sleeves stay on at the end: a taut sleeve snaps back
FRAME_GAP_MAX = 0.11  # [s] ten frames a second, with room for one late step
UPPER_ARM_MIN = 0.7  # way of the armhole from elbow (0) to shoulder (1)
COVERAGE_MIN = 0.8  # part of the torso front under cloth
OUTSIDE_MIN = 0.5  # part of the covered torso with the outside of the gown out
VERTEX_SPEED_MAX = 8.0  # [m/s] faster is a teleport
STRETCH_P99_MAX = 1.25  # 99th percentile of edge length over rest length, in every frame
STRETCH_MAX = 1.9  # longest edge over its rest length, in any frame
DEPTH_MAX = 0.015  # [m] of a vertex below the skin of an arm
LOAD_MAX = 25.0  # [N] cloth load while a gripper holds cloth
TRAVEL_MIN = 0.5  # [m] the gown came from the rail

INWARD = 0.10  # [m] the arm's line starts this far inside the shoulder
BEYOND = 0.05  # [m] and ends this far past the fingertip
COVER_BELOW, COVER_ABOVE = 0.02, 0.25  # [m] cloth this far under or over the skin covers it

# Of an unharmed person
WRIST_ABOVE_BED_MAX = 0.20  # [m] in the last `HOLD`: no arm lies higher than across the belly
ROBOT_DEPTH_HEAD_MAX = 0.002  # [m] of a link in head or neck: what numbers and frames may be off by, nothing more
ROBOT_DEPTH_MAX = 0.010  # [m] of a link in another part: flesh gives way by that much
FACE_REACH = 0.08  # [m] cloth nearer than this to mouth and nose lies on the face
FACE_LOOK = 0.2  # [s] the face is looked at this often
FACE_COVERED_MAX = 1.0  # [s] in one piece: a breath
LAYERS_MANY = 3  # layers of cloth that make a fold: one sheet lies on another where the gown laps over
LAYERS_SHARE_MAX = 0.15  # part of the torso front under `LAYERS_MANY`: folds press, and the person lies in them
OUTSIDE_NEAT_MIN = 0.9  # part of the covered torso with the outside out, as a nurse leaves it
COLLAR_ALONG = (-0.10, 0.08)  # [m] middle of the neckline from the shoulder line, towards the feet: not on the throat
COLLAR_ASIDE_MAX = 0.07  # [m] of it beside the middle of the shoulders: further out one shoulder is bare
# [N] on a part whose name contains the key, the first that fits: quasi-static contact of ISO/TS 15066, table A.2; an
# upper bound, for it is meant for healthy adults at work.  Of the head the face bears least.
FORCE_MAX = {
    "head": 65.0,
    "neck": 150.0,
    "trunk": 140.0,
    "torso": 140.0,
    "upper_arm": 150.0,
    "forearm": 160.0,
    "hand": 140.0,
}


def force_limit(part: str) -> float | None:
    """Largest force on a part of the body [N]; None where no limit is known."""
    return next((limit for key, limit in FORCE_MAX.items() if key in part), None)
