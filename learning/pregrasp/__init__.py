"""Which pre-grasp manipulation isolates a corner of a gown that hangs from one hand: tried, learned, compared."""
