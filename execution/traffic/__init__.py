"""Robots on one floor: who does which task, on which path, and who waits for whom. Pure."""
