"""Scores of what is seen against the truth of a picture, summed up over many pictures."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np

BINS = 10  # of confidences


@dataclass
class Tally:
    """Numbers that are collected under names: a `rate` of yes and no, a `median`, an `overlap`, a `calibration`."""

    hits: dict[str, list[bool]] = field(default_factory=lambda: defaultdict(list))
    values: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    areas: dict[str, np.ndarray] = field(default_factory=lambda: defaultdict(lambda: np.zeros(2)))
    sure: dict[str, np.ndarray] = field(default_factory=lambda: defaultdict(lambda: np.zeros((3, BINS))))

    def overlap(self, name: str, mine: np.ndarray, true: np.ndarray) -> None:
        """Add two masks (H, W) of one thing."""
        self.areas[name] += ((mine & true).sum(), (mine | true).sum())
        self.values[f"{name} pictures"].append(1.0)

    def confidence(self, name: str, confidence: np.ndarray, right: np.ndarray) -> None:
        """Add confidences (n,) and whether they were right (n,)."""
        bins = np.minimum((confidence * BINS).astype(int), BINS - 1)
        for row, weight in enumerate((np.ones(len(bins)), confidence, right)):
            self.sure[name][row] += np.bincount(bins, weights=weight, minlength=BINS)

    def iou(self, name: str) -> tuple[float, int]:
        """Intersection over union of all pictures together, and how many there were."""
        both, either = self.areas.get(name, (0.0, 0.0))
        return (float(both / either) if either else float("nan")), len(self.values.get(f"{name} pictures", []))

    def rate(self, name: str) -> tuple[float, int]:
        """Share of hits, and of how many."""
        hits = self.hits.get(name, [])
        return (float(np.mean(hits)) if hits else float("nan")), len(hits)

    def median(self, name: str) -> tuple[float, int]:
        """Median, and of how many."""
        values = self.values.get(name, [])
        return (float(np.median(values)) if values else float("nan")), len(values)

    def calibration_error(self, name: str) -> tuple[float, int]:
        """Mean difference of confidence and truth over bins, weighted by what is in them; and of how many."""
        if name not in self.sure:
            return float("nan"), 0
        count, confidence, right = self.sure[name]
        return float(np.abs(confidence - right).sum() / count.sum()), int(count.sum())
