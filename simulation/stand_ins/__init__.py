"""Stand-ins: simulated devices that take the place of real ones for a while."""
