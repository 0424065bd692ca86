"""A blind benchmark: sets with hidden effects, written by code that shares nothing with the workflow but the format."""
