"""Processes seen from outside: their heartbeats, what they count, and what about them people must know."""
