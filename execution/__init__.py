"""Carrying programs out: runs, the floor that robots share, commands to devices, rehearsals."""
