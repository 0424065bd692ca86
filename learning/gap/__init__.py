"""The sim-measured gap: find it, name the missing effect, add it to the model, show that it shrinks."""
