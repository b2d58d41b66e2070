"""Databases that restart while people draw."""
