"""Seeds that learning may see, and spans of them on a command line."""

from __future__ import annotations

import argparse

KEPT_SEEDS = 9000  # from here on no seed is for training or trying


def span_of_seeds(text: str) -> range:
    """`100-199`, or a single seed.

    Raises:
        argparse.ArgumentTypeError: it is none, is reversed, or holds seeds that are kept back.
    """
    first, dash, last = text.partition("-")
    try:
        found = range(int(first), int(last if dash else first) + 1)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no span of seeds; for example 110-139") from None
    if not found:
        raise argparse.ArgumentTypeError(f"{text!r} ends before it begins; a span is written like 110-139")
    if found[0] < 0 or found[-1] >= KEPT_SEEDS:
        raise argparse.ArgumentTypeError(f"{text!r}: seeds are 0 to {KEPT_SEEDS - 1}, later ones are kept for tests")
    return found
