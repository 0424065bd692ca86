"""Images in, typed estimates out."""
