"""Small clips whose motion follows two numbers exactly: what the learning tests learn from instead of gowns."""

from dataclasses import replace

import numpy as np
from caretree.learning.physics.methods.method import Examples

FRAMES, SIZE = 5, 16


def blob_frames(unit):
    """(N, P) in [0, 1] -> (N, 5, 2, 16, 16): the first number is the speed across, the second the depth's change."""
    unit = np.asarray(unit, float)
    t = np.linspace(0.0, 1.0, FRAMES)[None, :, None, None]
    y, x = np.mgrid[:SIZE, :SIZE] / (SIZE - 1.0)
    centre = 0.2 + 0.6 * unit[:, 0, None, None, None] * t
    shape = np.exp(-((x - centre) ** 2 + (y - 0.5) ** 2) / 0.05)
    depth = shape * (unit[:, 1, None, None, None] - 0.5) * t
    return np.stack([shape, depth], axis=2).astype(np.float16)


def blobs(count, parameters=2, seed=0):
    """Examples without classes."""
    unit = np.random.default_rng(seed).random((count, parameters))
    return Examples(frames=blob_frames(unit), unit=unit, class_id=np.full(count, -1), hash=f"blobs{count}-{seed}")


def blob_classes(classes, per_class, seed=0, spread=0.005):
    """Examples in classes, as in the paper's protocol."""
    rng = np.random.default_rng(seed)
    centres = np.random.default_rng(99).uniform(0.1, 0.9, (classes, 2))
    class_id = np.tile(np.arange(classes), per_class)
    unit = np.clip(centres[class_id] + rng.normal(0, spread, (len(class_id), 2)), 0, 1)
    return Examples(frames=blob_frames(unit), unit=unit, class_id=class_id, hash=f"classes{classes}-{seed}")


def as_tensors(examples):
    """The same examples as the networks want them."""
    import torch

    return replace(examples, frames=torch.from_numpy(examples.frames))


class BlobSimulator:
    """Stands in for the simulator of gowns."""

    def __init__(self, cut, camera=None):
        self.rendered = 0

    def __call__(self, unit, misplaced=None):
        self.rendered += len(unit)
        return blob_frames(unit)
