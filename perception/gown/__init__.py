"""Gown."""
