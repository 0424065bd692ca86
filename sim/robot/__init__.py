"""The robot: a dual-arm Baxter on a holonomic base, one model for pinocchio and PyBullet."""
