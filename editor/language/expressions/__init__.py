"""Expressions and their values: types, units, ranges, names and text."""
