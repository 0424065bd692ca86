"""What any robot with two arms is described by, and what follows from it: where it is, and what it touches."""
