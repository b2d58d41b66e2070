"""People: signing in, sessions, tokens, and requests that are sent again."""
