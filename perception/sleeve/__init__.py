"""Sleeve."""
