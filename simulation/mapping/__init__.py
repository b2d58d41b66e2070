"""Map making by a robot: pure, in virtual time, without a framework. `survey.py` puts it together.

`floor` and `odometry` are what the robot meets; `occupancy`, `scan_matching`, `exploration` and `map_maker` are what it
makes of it, knowing nothing of the truth; `survey` lets a robot map a floor, and `scores` holds its map against that.
"""
