"""Maps as grids of numbers: clearance, walls, comparison, files. Pure geometry."""
