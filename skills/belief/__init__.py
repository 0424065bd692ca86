"""Belief."""
