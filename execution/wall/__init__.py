"""What a wall screen shows: one site's map, devices, runs, alerts and stop, read only and without names of people."""
