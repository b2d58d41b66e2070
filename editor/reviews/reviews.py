"""Reviews as people see them: asked for, given and withdrawn, with what was approved last to compare with."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import datetime
from functools import cached_property
from itertools import islice
from typing import Any, Literal, NamedTuple
from uuid import UUID

from django.db import transaction
from django.db.models import Max, OuterRef, QuerySet, Subquery
from django.db.models.functions import Coalesce

from editor.documents.store import get_document
from editor.errors import BadRequest, MayNotReview
from editor.models import ReviewEntry, Version
from editor.programs.checking import build_surroundings
from editor.programs.compilations import compile_program
from editor.programs.programs import get_program
from editor.programs.versions import find_version, pin_version
from editor.reviews.gate import content_digest
from editor.reviews.rules import Rule, get_rule, hold_rule
from editor.reviews.standing import Standing, list_approved_digests, read_standing, read_standings, reviewers_of
from registry import services as registry
from vipo_device.protocol.texts import find_unfit, normal

Verdict = Literal["approved", "changes", "withdrawn"]
WhyNot = Literal["", "role", "own"]
MOST_NOTE = 500
MOST_SHOWN = 20
"""So many programs whose review waits for them a person is told of, those asked for last."""
MOST_LOOKED_AT, AT_ONCE = 500, 50
"""Of so many programs, those that a review was asked for last, it is looked at, in so many at once."""
MOST_WORDS = 100
"""So often a person may ask and say something about one content; to withdraw is always possible."""


@dataclass(frozen=True, slots=True)
class Review:
    """How a program's content stands, and what who asks may do about it.

    `number` is its newest version with this content, None where it is drawn and not pinned. `compare_with` is the
    version before it that was approved last. `why_not` says why the asker cannot approve it; `errors` and `warnings`
    are the findings of the checker at this content, at the site as it is now, None where nothing is reviewed: most
    sites demand nothing, and ask this before every run.
    """

    rule: Rule
    standing: Standing
    number: int | None
    compare_with: int | None
    why_not: WhyNot
    errors: int | None = None
    warnings: int | None = None


@dataclass(frozen=True, slots=True)
class AskedReview:
    """A version that somebody asked to have reviewed: `compare_with` is the one approved last before it."""

    program_id: UUID
    program: str
    number: int
    compare_with: int | None
    by: str
    note: str
    at: datetime


def list_asked(*, site: str, user: Any) -> list[AskedReview]:
    """Return the versions of a site that wait for a person's review, those asked for last first.

    A version waits for somebody who may approve it until they have said something about it, it is approved, or changes
    are asked for. Of each program only what was asked last counts.
    """
    rule = get_rule(site=site)
    if user.pk not in reviewers_of(site, rule):
        return []
    asked = ReviewEntry.objects.filter(program__site__slug=site, kind=ReviewEntry.Kind.ASKED)
    newest = asked.values("program_id").annotate(newest=Max("pk")).order_by("-newest")[:MOST_LOOKED_AT]
    waiting = _waiting(site, rule, user, [row["newest"] for row in newest])
    return [_asked(row, line) for row, line in islice(waiting, MOST_SHOWN)]


def _waiting(site: str, rule: Rule, user: Any, newest: list[int]) -> Iterator[tuple[ReviewEntry, _Line]]:
    """Go through what of these waits for a person, the newest first, and read no more of it than is taken."""
    pinned = Version.objects.filter(program_id=OuterRef("program_id"), number=OuterRef("number"))
    for start in range(0, len(newest), AT_ONCE):
        rows = ReviewEntry.objects.filter(pk__in=newest[start : start + AT_ONCE]).select_related("program")
        asked = list(rows.annotate(pinned_by=Subquery(pinned.values("author")[:1])).order_by("-pk"))
        standings = read_standings(site=site, digests={row.program_id: row.digest for row in asked}, rule=rule)
        for row in asked:
            line = _Line(row.program_id, site, rule, row.number)
            is_open = row.pinned_by != user.pk and _is_open(standings[row.program_id], user)
            if is_open and user.pk not in line.makers():
                yield row, line


def _is_open(standing: Standing, user: Any) -> bool:
    """Tell whether a content is still to be reviewed by somebody who may: also where the site demands nothing."""
    enough = len(standing.approved) >= max(1, standing.needed)
    return not (enough or standing.objecting or any(word.person == user.pk for word in standing.approved))


def _asked(row: ReviewEntry, line: _Line) -> AskedReview:
    before = line.approved_before()
    return AskedReview(row.program_id, row.program.name, row.number, before, row.name, row.note, row.at)


def show_review(*, program_id: UUID, user: Any, number: int | None = None) -> Review:
    """Return how a version stands, or the program as it is drawn now. Raises NoSuchProgram, UnreadableVersion."""
    site, rule = get_program(program_id=program_id).site, get_rule(site=_site(program_id))
    document = _document(program_id, number)
    digest = content_digest(document)
    if number is None:
        same = Version.objects.filter(program_id=program_id, digest=digest).order_by("-number").first()
        number = same.number if same else None
    line = _Line(program_id, site, rule, number)
    standing = read_standing(site=site, program_id=program_id, digest=digest, rule=rule)
    review = Review(rule, standing, number, line.approved_before(), line.why_not(user))
    if not rule.approvals and not standing.history:
        return review
    summary = compile_program(document, build_surroundings(site=site)).summary
    return replace(review, errors=summary.errors, warnings=summary.warnings)


def ask_for_review(*, program_id: UUID, user: Any, number: int | None = None, note: str = "") -> int:
    """Ask others to review a version, or the program as it is drawn now, which becomes a version; returns its number.

    Raises NoSuchProgram, BadRequest, DocumentHole.
    """
    note = _checked(note)
    if number is None:
        number = pin_version(program_id=program_id, user=user).number
    with transaction.atomic():
        hold_rule(_site(program_id))
        _write(program_id, number, ReviewEntry.Kind.ASKED, user, note)
    return number


def give_verdict(*, program_id: UUID, user: Any, number: int, verdict: Verdict, note: str = "") -> None:
    """Approve a version's content, ask for changes of it, or withdraw what one has said.

    Raises:
        MayNotReview: it is the person's own, or their role is not enough here.
        BadRequest: changes are asked for without a sentence that says which, or there is nothing to withdraw.
    """
    note = _checked(note)
    if verdict == "changes" and not note:
        raise BadRequest("Say in a sentence what is to be changed.")
    with transaction.atomic():
        site = _site(program_id)
        line = _Line(program_id, site, hold_rule(site), number)
        if verdict == "withdrawn":
            _require_own_word(program_id, number, user)
        else:
            _require_reviewer(line, user)
        _write(program_id, number, verdict, user, note)


def find_makers(*, program_id: UUID, number: int, site: str) -> frozenset[int]:
    """Return the ids of those who have drawn a version since the program was approved last, or pinned it.

    What is approved is judged as `site` would: it is the site at which the version shall run.
    """
    return _Line(program_id, site, get_rule(site=site), number).makers()


class _Drawn(NamedTuple):
    """A version: its content, who has drawn since the one before, and who pinned it."""

    number: int
    digest: str
    authors: list[int]
    author: int | None


@dataclass(frozen=True)
class _Line:
    """The versions of a program up to one of them, or to what is drawn now; what is approved is asked for once."""

    program: UUID
    site: str
    rule: Rule
    number: int | None

    def approved_before(self) -> int | None:
        """Return the last version before it whose content is approved."""
        rows = self._versions.filter(digest__in=self._approved)
        if self.number is not None:
            rows = rows.filter(number__lt=self.number)
        return rows.order_by("-number").values_list("number", flat=True).first()

    @property
    def _versions(self) -> QuerySet[Version]:
        return Version.objects.filter(program_id=self.program)

    @cached_property
    def _approved(self) -> frozenset[str]:
        return list_approved_digests(site=self.site, program_id=self.program, rule=self.rule)

    def makers(self) -> frozenset[int]:
        """Return the ids of those who have drawn since the last approved content, or pinned this version.

        An approval is of a content: who had drawn for an earlier version with the same one has drawn this, too, for
        it may have come back by an undo, or have been restored by somebody else.
        """
        later = [] if self.number is None else self._since_approved(self.number)
        if not later or later[-1].number != self.number:
            return frozenset()
        this, since = later[-1], set[int]()
        made = set() if this.author is None else {this.author}
        for version in later:
            since.update(version.authors)
            if version.digest == this.digest:
                made |= since
            if version.digest in self._approved:
                since.clear()
        return frozenset(made)

    def _since_approved(self, number: int) -> list[_Drawn]:
        """Return the versions up to this one, behind the last approved one before its content first came up."""
        content = self._versions.filter(number=number).values("digest")
        first = self._versions.filter(digest=Subquery(content)).order_by("number").values("number")[:1]
        before = self._versions.filter(digest__in=self._approved, number__lt=Subquery(first))
        last = Coalesce(Subquery(before.order_by("-number").values("number")[:1]), 0)
        rows = self._versions.filter(number__gt=last, number__lte=number).order_by("number")
        return [_Drawn(*row) for row in rows.values_list("number", "digest", "authors", "author")]

    def why_not(self, user: Any) -> WhyNot:
        """Say why somebody cannot approve it; empty if they can."""
        if user.pk not in reviewers_of(self.site, self.rule):
            return "role"
        return "own" if user.pk in self.makers() else ""


def _require_reviewer(line: _Line, user: Any) -> None:
    match line.why_not(user):
        case "role":
            least = line.rule.least_role
            raise MayNotReview(
                f"At this site a reviewer has the role {least} or more. Ask one of them.", {"why": "role"}
            )
        case "own":
            raise MayNotReview(
                "You have drawn or pinned this since it was approved last, so somebody else reviews it. Ask them.",
                {"why": "own"},
            )


def _require_own_word(program_id: UUID, number: int, user: Any) -> None:
    digest = content_digest(find_version(program_id=program_id, number=number).document)
    said = ReviewEntry.objects.filter(program_id=program_id, digest=digest, person_id=user.pk)
    last = said.exclude(kind=ReviewEntry.Kind.ASKED).order_by("-pk").first()
    if last is None or last.kind == ReviewEntry.Kind.WITHDRAWN:
        raise BadRequest("You have said nothing about this content that you could withdraw.")


def _write(program_id: UUID, number: int, kind: str, user: Any, note: str) -> None:
    version = find_version(program_id=program_id, number=number)
    digest = content_digest(version.document)
    said = ReviewEntry.objects.filter(program_id=program_id, digest=digest, person=user)
    if kind != ReviewEntry.Kind.WITHDRAWN and said.count() >= MOST_WORDS:
        raise BadRequest(
            f"You have asked or said something about this content {MOST_WORDS} times. Talk about it, or change it."
        )
    ReviewEntry.objects.create(
        program_id=program_id,
        number=number,
        digest=digest,
        kind=kind,
        person=user,
        name=user.display_name,
        note=note,
    )
    facts = {"program": get_program(program_id=program_id).name, "number": number}
    site = version.site
    registry.note_act(site_id=registry.get_site_id(site=site), code=f"review_{kind}", facts=facts)
    transaction.on_commit(lambda: registry.publish(site, {"type": "review"}))


def _checked(note: str) -> str:
    note = normal(note.strip())
    if len(note) > MOST_NOTE or find_unfit(note):
        raise BadRequest(f"A note of a review has at most {MOST_NOTE} characters. Shorten it.")
    return note


def _site(program_id: UUID) -> str:
    return get_program(program_id=program_id).site


def _document(program_id: UUID, number: int | None) -> Any:
    if number is None:
        return get_document(program_id=program_id)
    return find_version(program_id=program_id, number=number).document
