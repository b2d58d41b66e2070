"""Versions over HTTP: listed, named, copied, exported, compared, and restored as an edit of the program's room."""
