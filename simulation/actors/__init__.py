"""What simulated devices do with commands: pure, time is an argument."""

from simulation.actors.actor import Actor, Chance, Emit, InitialState
from simulation.actors.follower import Follower, Motion
from simulation.actors.machine import Machine
from simulation.actors.robot import Robot, Surroundings

__all__ = ["Actor", "Chance", "Emit", "Follower", "InitialState", "Machine", "Motion", "Robot", "Surroundings"]
