"""Records of dressing runs as the measurement, the dressing world led through them once more as the model."""
