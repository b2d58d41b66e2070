"""Document → tree."""
