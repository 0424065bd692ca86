"""A dropped body: its model, and the search for what slows or misreads it."""
