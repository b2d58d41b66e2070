"""The mirror: a virtual copy of each device at work, which obeys the same commands at the same time."""
