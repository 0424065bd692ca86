"""What the robot measured, saw and was really sent, in a file that Foxglove opens."""
