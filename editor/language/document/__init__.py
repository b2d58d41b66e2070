"""The document that people draw, as plain JSON: its outline, the order of its steps, its former formats."""
