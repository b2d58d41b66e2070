"""Script → tree."""
