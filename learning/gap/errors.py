"""Errors a user can cause, each one sentence that names file, column and row."""

from __future__ import annotations


class GapError(ValueError):
    """A measurement set, a model file or a command cannot be used as given."""
