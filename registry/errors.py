"""The root of every refusal that a person may read.

VipoError
 ├── RegistryError (registry): sites, maps, devices, members
 ├── EditorError (editor): programs, documents, the library
 └── ExecutionError (execution): runs, rehearsals, stops
"""

from __future__ import annotations


class VipoError(Exception):
    """A refusal: `code` for machines, `status` for HTTP, the message says what is wrong and how to mend it."""

    code = "refused"
    status = 400

    def __init__(self, detail: str) -> None:
        super().__init__(detail)
        self.detail = detail


class RegistryError(VipoError):
    """A refusal of the registry."""

    code = "registry"
