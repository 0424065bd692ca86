"""For how long does cloth lie on the face?"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from .limits import COVER_BELOW, FACE_LOOK, FACE_REACH
from .rays import meets


def face_covered(t: np.ndarray, vertices: np.ndarray, faces: np.ndarray, face: np.ndarray) -> tuple[float, float]:
    """The longest time in one piece, looked at every `FACE_LOOK`.

    Args:
        t: (T,) [s].
        vertices: (T, V, 3) [m].
        faces: (F, 3).
        face: (6,) point between mouth and nose and the outward normal there [m].

    Returns:
        How long [s], and when it ended [s].
    """
    every = max(1, round(FACE_LOOK / max(1e-3, float(np.median(np.diff(t))))))
    longest, ended, lasted = 0.0, float(t[0]), 0.0
    for before, now in pairwise(range(0, len(t), every)):
        height, _ = meets(vertices[now].astype(np.float64), faces, face[:3], face[3:], COVER_BELOW, FACE_REACH)
        lasted = lasted + float(t[now] - t[before]) if len(height) else 0.0
        if lasted > longest:
            longest, ended = lasted, float(t[now])
    return longest, ended
