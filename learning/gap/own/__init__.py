"""A simulator and effects of one's own in the workflow."""
