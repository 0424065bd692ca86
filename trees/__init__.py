"""What to do, and what if it fails: trees, the runner and the command line."""
