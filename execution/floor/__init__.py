"""The floor of a site in the database: one step of traffic, Stop all, another map, paths for drawing."""
