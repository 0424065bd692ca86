"""Leaves of the tree, one file each, and what they share."""
