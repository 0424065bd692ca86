"""What a trained network sees, run by OpenCV alone."""
