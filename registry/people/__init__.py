"""People: signing in, sessions, and who may do what."""
