"""The floor of a site in the database: its steps, stops, map changes."""
