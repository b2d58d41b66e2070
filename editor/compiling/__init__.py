"""Checks of programs beside the web process: child processes that keep what they know of each program."""
