"""How far off the robot's senses are: one kind of error a file, none of which touches the physics or the record."""
