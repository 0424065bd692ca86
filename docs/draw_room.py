"""Draws docs/room.svg, the map of the simulated room from above: `python docs/draw_room.py`.

White is where the middle of the base may be; blue arrows are waypoints of the map, orange ones stances beside the bed,
each pointing to where the robot looks.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np
from caretree.sim.scene.scene import room_map
from caretree.sim.world import SIDES
from caretree.skills.geometry.stances import STANCES, stance, stance_at_head
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

HERE = Path(__file__).parent
WAYPOINT, STANCE = "#1f6fb2", "#c8641b"
ARROW = 0.32  # [m]
SHOWN = ((-2.1, 3.6), (-2.2, 2.4))  # [m] of the map


def places() -> dict[str, tuple[float, float, float, str]]:
    """Name -> x, y [m], yaw [rad] and colour of every place with a name."""
    found = {name: (*pose, WAYPOINT) for name, pose in room_map().waypoints.items()}
    for arm in SIDES:
        for stand in ("lift", "shoulder"):
            x, y, yaw = stance(arm, stand)
            found[f"{stand}, {arm}"] = (float(x), float(y), float(yaw), STANCE)
    found["head"] = (*(float(value) for value in stance_at_head()), STANCE)
    found["lane"] = (STANCES.lane, 0.55, STANCES.heading, STANCE)
    return found


def _arrow(axes: Axes, name: str, x: float, y: float, yaw: float, colour: str) -> None:
    dx, dy = ARROW * np.cos(yaw), ARROW * np.sin(yaw)
    axes.plot(x, y, "o", color=colour, markersize=4)
    axes.annotate("", (x + dx, y + dy), (x, y), arrowprops={"arrowstyle": "->", "color": colour, "linewidth": 1.4})
    away = (-np.sign(dx) * 0.08, 0.0) if abs(dx) > abs(dy) else (0.08, 0.0)
    side = "right" if away[0] < 0 else "left"
    axes.text(x + away[0], y + away[1], name, color=colour, fontsize=7, ha=side, va="center")


def draw(path: Path) -> None:
    """Write the picture."""
    room = room_map()
    plt.rcParams |= {"svg.fonttype": "none", "svg.hashsalt": "caretree"}
    figure, axes = plt.subplots(figsize=(7.2, 5.8), layout="constrained")
    rows, columns = room.free.shape
    extent = (
        room.origin[0],
        room.origin[0] + columns * room.resolution,
        room.origin[1],
        room.origin[1] + rows * room.resolution,
    )
    axes.imshow(np.where(room.free, 255, 226), cmap="gray", vmin=0, vmax=255, origin="lower", extent=extent)
    (x, y, _), (width, depth, _) = room.bed[0], room.bed[1] - room.bed[0]
    axes.add_patch(Rectangle((x, y), width, depth, facecolor="#dce8f2", edgecolor="#66727d"))
    axes.text(x + width / 2, y + 0.15, "head", ha="center", fontsize=8)
    axes.text(x + width / 2, y + depth / 2, "bed", ha="center", fontsize=8)
    for name, place in places().items():
        _arrow(axes, name, *place)
    axes.set(xlim=SHOWN[0], ylim=SHOWN[1], xlabel="x of the map [m]", ylabel="y of the map [m]", aspect="equal")
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


if __name__ == "__main__":
    draw(HERE / "room.svg")
