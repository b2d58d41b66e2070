"""The simulation app."""

from django.apps import AppConfig
from django.core.exceptions import ImproperlyConfigured

from simulation.kind_file import BadKinds, default_kinds


class SimulationConfig(AppConfig):
    """Settings of the simulation app."""

    name = "simulation"

    def ready(self) -> None:
        """Read the kinds once: a file of one's own that cannot be read stops the start."""
        try:
            default_kinds()
        except BadKinds as error:
            raise ImproperlyConfigured(error.detail) from error
