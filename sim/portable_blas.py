"""The same sums on every processor: OpenBLAS orders them by the loops it picks for it, and traces hang on last bits."""

from __future__ import annotations

import os
import platform
from pathlib import Path

CORE = "Haswell"  # OpenBLAS's loops for AVX2 and FMA, which every x86-64 processor in use has
NEEDED = {"avx2", "fma"}
CPU = Path("/proc/cpuinfo")
FIRST = 8192  # characters, in which the first core's flags are


def portable_blas() -> None:
    """Have OpenBLAS take the loops that all processors have, where it is loaded later; what the user set stays.

    A run of one seed went another way from 133 s on where AVX-512 was at hand: a product's last bit decided.
    """
    if has_them():
        os.environ.setdefault("OPENBLAS_CORETYPE", CORE)


def has_them() -> bool:
    """Whether this processor has what those loops need; only Linux says."""
    if platform.machine() not in ("x86_64", "AMD64") or not CPU.exists():
        return False
    with CPU.open() as file:
        return set(file.read(FIRST).split()) >= NEEDED
