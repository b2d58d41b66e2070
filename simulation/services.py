"""What other apps may ask of the simulation."""

from __future__ import annotations

from typing import Literal

from simulation.kinematic import KinematicDriver
from simulation.simulated_world import SimulatedWorld
from simulation.world import Scene, World

DriverName = Literal["physics", "kinematic"]


def make_world(*, scene: Scene, driver: DriverName = "physics") -> World:
    """Return a world in virtual time; `physics` loads PyBullet, which wants a process and one thread for itself."""
    if driver == "kinematic":
        return SimulatedWorld(scene, KinematicDriver)
    if driver == "physics":
        from simulation.physics import PhysicsDriver

        return SimulatedWorld(scene, PhysicsDriver)
    raise ValueError(f"There is no driver {driver!r}; there are 'physics' and 'kinematic'.")
