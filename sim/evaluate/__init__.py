"""Decides from a run's truth alone whether the person is dressed."""
