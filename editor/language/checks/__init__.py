"""The checks: what is wrong with a program at its site, or odd about it."""
