"""The gate before real devices, at every way to a start."""
