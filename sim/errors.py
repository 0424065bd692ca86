"""The one root of every error the project raises on purpose."""

from __future__ import annotations


class CaretreeError(Exception):
    """A user's or a world's mistake, told in one sentence; the command line prints it and exits with 2."""


class RecordError(CaretreeError):
    """A record cannot be written or read."""


class DisplayError(CaretreeError):
    """A run cannot be shown to whoever follows it."""
