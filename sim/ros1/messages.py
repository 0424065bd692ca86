"""Messages that Debian does not carry, made by its genpy from their authors' definitions in `definitions/`."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

from .ros import ros

DEFINITIONS = Path(__file__).parent / "definitions"
LINE = "\n" + "=" * 80 + "\n"
ACTION = {  # what actionlib makes of an action, by its documentation
    "ActionGoal": "Header header\nactionlib_msgs/GoalID goal_id\n{name}Goal goal\n",
    "ActionResult": "Header header\nactionlib_msgs/GoalStatus status\n{name}Result result\n",
    "ActionFeedback": "Header header\nactionlib_msgs/GoalStatus status\n{name}Feedback feedback\n",
    "Action": "{name}ActionGoal action_goal\n{name}ActionResult action_result\n{name}ActionFeedback action_feedback\n",
}


@lru_cache
def message(kind: str) -> Any:
    """The class of a message such as `control_msgs/FollowJointTrajectoryAction`.

    Raises:
        RosMissing: ROS 1 is not there.
        KeyError: it is not among the definitions.
    """
    return _classes()[kind]


@lru_cache
def _classes() -> dict[str, Any]:
    texts = _debian() | _definitions()
    from genpy.dynamic import generate_dynamic  # pyright: ignore[reportMissingImports] found once ros() has looked

    first, *others = texts
    parts = [texts[first], *(f"MSG: {kind}\n{texts[kind]}" for kind in others)]
    return generate_dynamic(first, LINE.join(parts))


def _definitions() -> dict[str, str]:
    texts = {}
    for path in sorted(DEFINITIONS.glob("*/*")):
        name, text = f"{path.parent.name}/{path.stem}", path.read_text(encoding="utf-8")
        if path.suffix == ".msg":
            texts[name] = text
        elif path.suffix == ".action":
            for part, each in zip(("Goal", "Result", "Feedback"), text.split("---\n"), strict=True):
                texts[name + part] = each
            texts |= {name + part: each.format(name=path.stem) for part, each in ACTION.items()}
    return texts


def _debian() -> dict[str, str]:
    """Those on which they are built, as Debian's own classes give them."""
    there, texts = ros(), {}
    for kind in (
        there.std_msgs.Header,
        there.trajectory_msgs.JointTrajectory,
        there.actionlib_msgs.GoalStatus,
    ):
        own, *others = kind._full_text.split(LINE)
        texts[kind._type] = own
        for other in others:
            head, _, text = other.partition("\n")
            texts[head.removeprefix("MSG: ").strip()] = text
    return texts
