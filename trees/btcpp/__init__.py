"""Trees in the XML of BehaviorTree.CPP 4: read, written, and described for the palette of Groot2."""
