"""Runs in the database: their steps, journal, questions, notices and triggers."""
