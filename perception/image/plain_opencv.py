"""OpenCV without what the processor at hand adds: the same picture then gives the same numbers on every machine."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def plain_opencv() -> Iterator[None]:
    """Have OpenCV run its own loops meanwhile, not those that it chooses by the processor.

    Distances and gradients of a picture (`distanceTransform`, `Sobel`) end in other bits there, by up to 7e-6 pixels,
    and a run of one seed then went another way from 149 s on.  Masks, medians and colours are the same either way.
    """
    import cv2

    before = cv2.useOptimized()
    cv2.setUseOptimized(False)
    try:
        yield
    finally:
        cv2.setUseOptimized(before)
