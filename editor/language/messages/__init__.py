"""What the language says to people, in each language, as data."""
