"""Errors a user can cause, each one sentence that names file, column and row."""

from __future__ import annotations

from ...sim.errors import CaretreeError


class GapError(CaretreeError):
    """A measurement set, a model file or a command cannot be used as given."""
