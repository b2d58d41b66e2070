"""The tree of a program: typed nodes, and ways to walk through it."""
