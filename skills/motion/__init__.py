"""Motions: inverse kinematics, timed trajectories, paths of the base."""
