"""The simulation app."""

from django.apps import AppConfig


class SimulationConfig(AppConfig):
    """Settings of the simulation app."""

    name = "simulation"
