"""A robot behind a ROS 1 master, and a simulated world that stands there as one."""
