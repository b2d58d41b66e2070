"""The embedded mode: everything in one process group, for `make demo`."""
