"""Cloth: predicted by the PyBullet world, screened by sensitivities, verified by simulation."""
