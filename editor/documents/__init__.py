"""The shared documents of programs: their content as Yjs and as plain JSON, and their rows in the database."""
