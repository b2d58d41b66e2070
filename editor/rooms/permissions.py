"""Who may sit in a program's room."""

from __future__ import annotations

from dataclasses import dataclass

from django.contrib.auth import get_user_model

from editor.models import Program
from editor.rooms.member import Person
from registry.services import find_access


@dataclass(frozen=True, slots=True)
class Standing:
    """What a person may do with a program: everybody of its site may look, authors may change."""

    site: str
    person: Person
    can_write: bool


def find_standing(user_id: int, program_id: str) -> Standing | None:
    """Return a person's standing; None when the program does not exist or is none of theirs: the two look the same."""
    program = Program.objects.select_related("site").filter(pk=program_id).first()
    user = get_user_model().objects.filter(pk=user_id, is_active=True).first()
    access = find_access(user, program.site) if program and user else None
    if program is None or user is None or access is None:
        return None
    return Standing(program.site.slug, Person(user.pk, user.display_name, user.initials), access.allows("author"))
