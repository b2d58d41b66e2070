"""The root of the registry's refusals; each stands beside what raises it."""

from __future__ import annotations

from vipo_device.protocol.errors import VipoError


class RegistryError(VipoError):
    """A refusal of the registry."""

    code = "registry"
