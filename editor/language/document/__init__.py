"""The document that people draw, as plain JSON: its outline, its order, its former formats."""
