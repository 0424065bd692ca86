"""The map of a site: its grid from a topic, its waypoints and its bed from a parameter of the master."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..world import RoomMap, WorldError
from .clock import parameter
from .ros import ros
from .site import Site

ASKED = "waypoints (name: [x, y, yaw]) and bed ([[x, y, z], [x, y, z]])"


def read_room(rospy: Any, site: Site, patience: float) -> RoomMap:
    """The room.

    Raises:
        WorldError: there is no map within `patience` [s], or its annotations are missing or wrong.
    """
    try:
        grid = rospy.wait_for_message(site.room.grid, ros().nav_msgs.OccupancyGrid, patience)
    except rospy.ROSException as error:
        raise WorldError(
            f"no map comes on {site.room.grid}: does the robot run, or `caretree serve-robot`?  "
            "`caretree robot doctor` tells what is missing"
        ) from error
    notes = parameter(site.room.annotations)
    if notes is None:
        raise WorldError(f"the master has no parameter {site.room.annotations}, but one with {ASKED} is asked for")
    try:
        bed = np.array(notes["bed"], float).reshape(2, 3)
        waypoints = {}
        for name, place in notes["waypoints"].items():
            x, y, yaw = map(float, place)
            waypoints[str(name)] = (x, y, yaw)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise WorldError(f"parameter {site.room.annotations} is {notes!r}, but {ASKED} are asked for") from error
    info = grid.info
    return RoomMap(
        free=np.array(grid.data, np.int8).reshape(info.height, info.width) == 0,
        origin=np.array((info.origin.position.x, info.origin.position.y)),
        resolution=round(float(info.resolution), 6),  # a 32-bit number
        waypoints=waypoints,
        bed=bed,
    )


def room_messages(room: RoomMap) -> tuple[Any, dict[str, Any]]:
    """The grid and the annotations of a room, as a robot's side gives them."""
    grid = ros().nav_msgs.OccupancyGrid()
    grid.info.height, grid.info.width = room.free.shape
    grid.info.resolution = float(room.resolution)
    grid.info.origin.position.x, grid.info.origin.position.y = map(float, room.origin)
    grid.info.origin.orientation.w = 1.0
    grid.data = np.where(room.free, 0, 100).ravel().tolist()
    waypoints = {name: [float(each) for each in place] for name, place in room.waypoints.items()}
    return grid, {"waypoints": waypoints, "bed": np.asarray(room.bed, float).tolist()}
