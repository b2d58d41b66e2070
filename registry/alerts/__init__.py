"""Alerts of a site: what causes them, how they are raised, gathered, shown and ended."""
