"""How long what has ended is kept as rows, and how it becomes an archive."""
