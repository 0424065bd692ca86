"""Worlds behind one contract: PyBullet soft body, scripted, and what they are made of."""
