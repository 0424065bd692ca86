"""Data in, weights or models out."""
