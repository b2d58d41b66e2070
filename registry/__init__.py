"""People, sites, maps and devices, kept as rows."""
