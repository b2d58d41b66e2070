"""Histories as files: compressed JSON lines, how they are written, and how they are opened again."""
