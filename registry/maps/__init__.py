"""A site's maps: their versions, and the maps that robots send."""
