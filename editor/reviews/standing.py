"""How a program's content stands: who has approved it, who wants it changed, what is missing for a run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime
from uuid import UUID

from editor.models import ReviewEntry
from editor.reviews.rules import Rule
from registry import services as registry


@dataclass(frozen=True, slots=True)
class Word:
    """What somebody said about a content; `counts` unless it was withdrawn, or they may not approve any more."""

    person: int | None
    name: str
    kind: str
    note: str
    number: int
    at: datetime
    counts: bool


@dataclass(frozen=True, slots=True)
class Standing:
    """How many approvals are needed, whose count, and who wants changes."""

    needed: int
    approved: tuple[Word, ...]
    objecting: tuple[Word, ...]
    history: tuple[Word, ...]

    @property
    def missing(self) -> int:
        """How many approvals are still missing."""
        return max(0, self.needed - len(self.approved))

    @property
    def may_run(self) -> bool:
        """Tell whether a run on real devices may start: nothing is demanded, or all of it is there."""
        return self.needed == 0 or (self.missing == 0 and not self.objecting)


def read_standing(*, site: str, program_id: UUID | str, digest: str, rule: Rule) -> Standing:
    """Return how this content of a program stands under a rule, as the members of the site are now."""
    rows = list(ReviewEntry.objects.filter(program_id=program_id, digest=digest).order_by("pk"))
    return _stand(rows, reviewers_of(site, rule), rule)


def read_standings(*, site: str, digests: Mapping[UUID, str], rule: Rule) -> dict[UUID, Standing]:
    """Return how a content of each of these programs stands, as `read_standing` does, in as many statements."""
    by_program: dict[UUID, list[ReviewEntry]] = {program: [] for program in digests}
    said = ReviewEntry.objects.filter(program_id__in=list(digests), digest__in=set(digests.values()))
    for row in said.order_by("pk"):
        if row.digest == digests[row.program_id]:
            by_program[row.program_id].append(row)
    reviewers = reviewers_of(site, rule)
    return {program: _stand(rows, reviewers, rule) for program, rows in by_program.items()}


def reviewers_of(site: str, rule: Rule) -> frozenset[int]:
    """Return the ids of those who may approve at a site now; whose access has ended is not among them."""
    return registry.list_with_role(site=site, role=rule.least_role)


def list_approved_digests(*, site: str, program_id: UUID | str, rule: Rule) -> frozenset[str]:
    """Return the contents of a program that are approved now; where nothing is demanded one approval does."""
    by_digest: dict[str, list[ReviewEntry]] = {}
    for row in ReviewEntry.objects.filter(program_id=program_id).order_by("pk"):
        by_digest.setdefault(row.digest, []).append(row)
    reviewers, least = reviewers_of(site, rule), Rule(max(1, rule.approvals), rule.least_role)
    return frozenset(digest for digest, rows in by_digest.items() if _stand(rows, reviewers, least).may_run)


def _stand(rows: Iterable[ReviewEntry], reviewers: frozenset[int], rule: Rule) -> Standing:
    rows = list(rows)
    last = {row.person_id: row.pk for row in rows if row.kind != ReviewEntry.Kind.ASKED}
    history = tuple(_word(row, row.person_id in reviewers and last.get(row.person_id) == row.pk) for row in rows)
    return Standing(
        needed=rule.approvals,
        approved=tuple(word for word in history if word.counts and word.kind == ReviewEntry.Kind.APPROVED),
        objecting=tuple(word for word in history if word.counts and word.kind == ReviewEntry.Kind.CHANGES),
        history=history,
    )


def _word(row: ReviewEntry, counts: bool) -> Word:
    return Word(row.person_id, row.name, row.kind, row.note, row.number, row.at, counts)
