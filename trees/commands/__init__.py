"""What each command of `caretree` does; imported when it is called, so that `caretree --help` is instant."""
