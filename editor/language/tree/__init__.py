"""The tree of a program: its typed nodes, and what follows from them alone."""
