"""The map of a site over HTTP, with the places and zones on it."""
