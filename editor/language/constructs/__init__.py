"""One record for each construct of the language: what it is told, how it is written, and how it looks."""
