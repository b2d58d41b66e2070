"""The gate before real devices: every start passes `admit_start`, in the transaction that starts the run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from editor.documents.plain_form import digest_of
from editor.documents.shared_document import migrate_document
from editor.errors import NotApproved
from editor.reviews.rules import get_rule, hold_rule
from editor.reviews.standing import Standing, read_standing

MOST_REASON = 500


@dataclass(frozen=True, slots=True)
class Permit:
    """Why a run was let start: how many approvals were demanded, who gave them, or an admin's reason for an emergency.

    Of a run that needed none all of it is empty.
    """

    needed: int = 0
    approved_by: tuple[str, ...] = ()
    emergency: str = ""


def admit_start(*, site: str, program_id: UUID, document: Mapping[str, Any], emergency: str = "") -> Permit:
    """Let a run of just this document start on a site's devices, or refuse it.

    Call it in the transaction that writes the run: until that ends nobody changes what the site demands, approves or
    withdraws. `emergency` is an admin's reason for a start all the same; who may give one is the caller's to see to.

    Raises:
        NotApproved: approvals that the site demands are missing, or a reviewer wants changes.
    """
    rule = hold_rule(site)
    if rule.approvals == 0:
        return Permit()
    digest = content_digest(document)
    standing = read_standing(site=site, program_id=program_id, digest=digest, rule=rule)
    names = tuple(word.name for word in standing.approved)
    if standing.may_run:
        return Permit(rule.approvals, names)
    if emergency:
        return Permit(rule.approvals, names, emergency)
    raise _refusal(standing)


def is_admitted(*, site: str, program_id: UUID, document: Mapping[str, Any]) -> bool:
    """Tell whether a run of this document might start now; for one that was admitted earlier, when its time comes."""
    rule = get_rule(site=site)
    if rule.approvals == 0:
        return True
    return read_standing(site=site, program_id=program_id, digest=content_digest(document), rule=rule).may_run


def content_digest(document: Mapping[str, Any]) -> str:
    """Return the digest of what a run of this document carries out.

    A document holds all that it calls: functions of a library stand in it in the version that was brought in.
    """
    return digest_of(migrate_document(document)) if document else digest_of({})


def _refusal(standing: Standing) -> NotApproved:
    facts = {
        "why": "changes" if standing.objecting else "approvals",
        "needed": standing.needed,
        "given": len(standing.approved),
        "by": [word.name for word in standing.objecting or standing.approved],
    }
    if standing.objecting:
        first = standing.objecting[0]
        return NotApproved(
            f"{first.name} asks for changes of this program as it is: {first.note} Change it and ask for a review, "
            "or ask them to approve it.",
            facts,
        )
    return NotApproved(
        f"What runs on this site's devices needs approvals: {standing.needed}. For the program as it is there are "
        f"{len(standing.approved)}. Ask for a review of it, then start it again.",
        facts,
    )
