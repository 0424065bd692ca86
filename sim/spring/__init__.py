"""Cloth as springs, compiled: a second engine beside PyBullet's soft bodies."""
