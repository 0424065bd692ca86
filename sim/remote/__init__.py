"""A world in another process, perhaps on another machine and another Python."""
