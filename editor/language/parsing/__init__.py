"""Script → tree: the closed subset of Python that the language prints, read back."""
