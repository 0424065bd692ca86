"""Learn a garment's physics from one depth clip of it falling."""
