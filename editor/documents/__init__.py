"""The shared documents of programs: their content as Yjs and as plain JSON, and how the database keeps it."""
