"""Rehearsals: a program carried out in a simulated copy of its site, in a process of its own."""
