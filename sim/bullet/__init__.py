"""Bullet."""
