"""A run in Groot2, the viewer of BehaviorTree.CPP: its protocol, and breakpoints."""
