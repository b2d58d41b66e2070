"""Live news to browsers, and hints that wake waiting threads."""
