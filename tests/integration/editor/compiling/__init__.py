"""Programs checked in child processes."""
