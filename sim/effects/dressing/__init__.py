"""Effects on a dressing run: of the person's arms, of sleeve and fabric, and of what sensors tell."""
