"""Tasks by name, one file or folder each: a module with `build(context, **params)` that returns the tree's root."""
