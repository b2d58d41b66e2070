"""Machines whose MTConnect agents are read, versions 1.2 to 2.x."""
