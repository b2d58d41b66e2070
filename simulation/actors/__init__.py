"""What pretend devices do with commands: pure, time is an argument."""

from simulation.actors.actor import Actor, Beginning, Emit
from simulation.actors.follower import Follower, Motion
from simulation.actors.machine import Machine
from simulation.actors.robot import Robot, Surroundings

__all__ = ["Actor", "Beginning", "Emit", "Follower", "Machine", "Motion", "Robot", "Surroundings"]
