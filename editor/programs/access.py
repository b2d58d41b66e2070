"""Who may do what with a program."""

from __future__ import annotations

from typing import Any
from uuid import UUID

from editor.errors import NoSuchProgram
from editor.programs.programs import GONE, get_program
from editor.programs.views import ProgramView
from registry.services import NotAMember, require


def program_for(user: Any, program: UUID, role: str, scope: str = "") -> ProgramView:
    """Return a program if somebody has that role at its site; to strangers it does not exist.

    `scope` is what a token must be for, where that is not what the role stands for.

    Raises NoSuchProgram, NotAllowed.
    """
    found = get_program(program_id=program)
    require_here(user, found.site, role, scope)
    return found


def require_here(user: Any, site: str, role: str, scope: str = "") -> None:
    """Require a role at a site; strangers get the very answer that they get for what does not exist."""
    try:
        require(user, site, role, scope)
    except NotAMember as error:
        raise NoSuchProgram(GONE) from error
