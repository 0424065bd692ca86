"""What a model leaves of recordings although nothing is missing, and which effects are no more than that.

Solvers, contacts and what a recording cannot say of its first instant leave something of every recording: slow, and
another each time.  Noise that is estimated from the residual does not know of it where few recordings were made.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..joints.block import Block
from ..joints.log import JointLog

SHAPES = 3  # slowest cosines of a recording, which share the error
SURE = 1.96  # standard deviations by which a number has to differ from none


def deviations(blocks: Sequence[Block], weight: np.ndarray, logs: list[JointLog], rms: np.ndarray) -> np.ndarray:
    """Standard deviations (k,) that the model's own error gives the linear parameters of a set.

    Args:
        blocks: the set.
        weight: (C,) of the channels in the fit.
        logs: what it was fitted to.
        rms: (C,) of the error.
    """
    k = sum(len(b.parameters) for b in blocks)
    if not k or not rms.any():
        return np.zeros(k)
    normal, spread = np.zeros((k, k)), np.zeros((k, k))
    for log in logs:
        X = np.zeros((len(log.t[log.inner]), len(weight), k))
        at = 0
        for b in blocks:
            X[:, list(b.channels), at : at + len(b.parameters)] = b.build(log)
            at += len(b.parameters)
        normal += np.einsum("tcp,tcq,c->pq", X, X, weight)
        share = (np.arange(len(X)) + 0.5) / len(X)
        shapes = np.stack([np.cos(np.pi * n * share) * (np.sqrt(2.0) if n else 1.0) for n in range(SHAPES)])
        moved = np.einsum("nt,tcp,c->ncp", shapes, X, weight * rms / np.sqrt(SHAPES))
        spread += np.einsum("ncp,ncq->pq", moved, moved)
    inverse = np.linalg.pinv(normal, hermitian=True)
    return np.sqrt(np.maximum(np.diag(inverse @ spread @ inverse), 0.0))


def least_sure(blocks: Sequence[Block], theta: np.ndarray, sd: np.ndarray) -> int | None:
    """The effect that is least above the model's error, or None where all are well above.

    Args:
        blocks: the set.
        theta: (k,) its parameters.
        sd: (k,) of `deviations`.
    """
    ratios, at = [], 0
    for b in blocks:
        span = slice(at, at + len(b.parameters))
        ratios.append(float(np.max(np.abs(theta[span]) / np.maximum(sd[span], 1e-300))))
        at = span.stop
    if not ratios or min(ratios) >= SURE:
        return None
    return int(np.argmin(ratios))


def size_in_errors(block: Block, theta: np.ndarray, logs: list[JointLog], model_error: np.ndarray) -> float:
    """How much an effect changes the predictions, root mean square over the model's own error, where it does most.

    Args:
        block: columns of the effect.
        theta: its values.
        logs: the recordings.
        model_error: (C,) root mean square; where it is 0 for a channel, anything on that is infinitely much.
    """
    moved = np.sqrt(np.mean(np.concatenate([block.build(log) @ theta for log in logs]) ** 2, axis=0))
    return float(np.max(moved / np.maximum(model_error[list(block.channels)], 1e-30)))


def faintest(blocks: Sequence[Block], theta: np.ndarray, logs: list[JointLog], model_error: np.ndarray) -> int | None:
    """The effect that changes the predictions least, if it changes none by more than the model errs by itself.

    Args:
        blocks: columns of the effects.
        theta: their values, one after the other.
        logs: the recordings.
        model_error: (C,) as in `size_in_errors`.
    """
    ends = np.cumsum([len(block.parameters) for block in blocks])
    sizes = [
        size_in_errors(block, theta[end - len(block.parameters) : end], logs, model_error)
        for block, end in zip(blocks, ends, strict=True)
    ]
    return int(np.argmin(sizes)) if sizes and min(sizes) < 1.0 else None
