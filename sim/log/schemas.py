"""What stands in each message of a log, as JSON Schema.

The names that begin with `foxglove.` are Foxglove's own, so that its panels draw them; of their fields the log writes
those that are listed here.
"""

from __future__ import annotations

from typing import Any


def _object(**fields: Any) -> dict[str, Any]:
    return {"type": "object", "properties": fields}


def _list(items: dict[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": items}


NUMBER, WORD, WHOLE = {"type": "number"}, {"type": "string"}, {"type": "integer"}
BYTES = {"type": "string", "contentEncoding": "base64"}
TIME = {**_object(sec=WHOLE, nsec=WHOLE), "title": "time"}
VECTOR = _object(x=NUMBER, y=NUMBER, z=NUMBER)
QUATERNION = _object(x=NUMBER, y=NUMBER, z=NUMBER, w=NUMBER)
PLANAR = _object(x=NUMBER, y=NUMBER, yaw=NUMBER)

SCHEMAS: dict[str, dict[str, Any]] = {
    "foxglove.JointStates": _object(
        timestamp=TIME, joints=_list(_object(name=WORD, position=NUMBER, velocity=NUMBER, effort=NUMBER))
    ),
    "foxglove.FrameTransforms": _object(
        transforms=_list(
            _object(timestamp=TIME, parent_frame_id=WORD, child_frame_id=WORD, translation=VECTOR, rotation=QUATERNION)
        )
    ),
    "foxglove.CompressedImage": _object(timestamp=TIME, frame_id=WORD, data=BYTES, format=WORD),
    "foxglove.RawImage": _object(
        timestamp=TIME, frame_id=WORD, width=WHOLE, height=WHOLE, encoding=WORD, step=WHOLE, data=BYTES
    ),
    "foxglove.CameraCalibration": _object(
        timestamp=TIME,
        frame_id=WORD,
        width=WHOLE,
        height=WHOLE,
        distortion_model=WORD,
        D=_list(NUMBER),
        K=_list(NUMBER),
        R=_list(NUMBER),
        P=_list(NUMBER),
    ),
    "caretree.Measured": _object(
        timestamp=TIME,
        emergency_stop={"type": "boolean"},
        base_in_map=PLANAR,
        twist_in_base=PLANAR,
        left_hand=_object(force=VECTOR, torque=VECTOR),
        right_hand=_object(force=VECTOR, torque=VECTOR),
    ),
    "caretree.Sent": _object(timestamp=TIME, command=WORD),
}
