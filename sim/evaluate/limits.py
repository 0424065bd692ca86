"""Bounds of a dressed person and of a believable simulation, each with its reason."""

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
