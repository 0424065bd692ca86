"""The workflow up to its verdict."""

from caretree.learning.gap.measurement import load_set
from caretree.learning.gap.open_study import open_study


def solved(folder):
    """The study of a set, and what its step `name` returns."""
    study = open_study(load_set(folder))
    return study, *study.name()
