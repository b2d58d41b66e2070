"""Expressions: their nodes, and their types, units, ranges, names and texts."""
