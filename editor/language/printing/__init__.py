"""Tree → script."""
