"""Tree → script: the Python text that people read and edit."""
