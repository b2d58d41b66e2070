"""A version made a program of its own, which remembers who had drawn it."""

from __future__ import annotations

from typing import Any
from uuid import UUID

from editor import services
from editor.programs.views import ProgramView
from editor.reviews.reviews import find_makers


def copy_version(*, program_id: UUID, number: int, name: str, user: Any) -> ProgramView:
    """Make a new program of the same site of a version. Raises NoSuchProgram, BadRequest, UnreadableVersion."""
    version = services.find_version(program_id=program_id, number=number)
    makers = find_makers(program_id=program_id, number=number, site=version.site)
    return services.create_program(site=version.site, name=name, document=version.document, user=user, makers=makers)
