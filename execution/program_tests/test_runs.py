"""Tests put into the queue of rehearsals: by people, and for each version that somebody has named."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any
from uuid import UUID

from django.db import transaction

from editor import services as editor
from execution.errors import NotFound, NotReady, TooManyRehearsals
from execution.floor.layouts import place_facts
from execution.mirror.calibrations import find_paces
from execution.models import ProgramTest, Rehearsal, TrialRun
from execution.program_tests.site_digests import digests_of
from execution.program_tests.stored_tests import say_changed
from execution.rehearsals.child_process import scene_to_json
from execution.rehearsals.rehearsals import put_into_queue, refuse_too_many
from execution.runs.programs import not_ready
from registry import services as registry
from simulation.world import Scene
from vipo_device.protocol.errors import VipoError

log = logging.getLogger(__name__)
VERSIONS_AT_ONCE = 20
NO_TESTS = "The program has no tests yet. Write one first."
MOST_SEEDS = 100
MOST_CHANGES = 100


@dataclass(frozen=True, slots=True)
class Extent:
    """How much is asked: with how many seeds besides its own each test, and whether changes of the program are tried.

    Both have the time of one rehearsal; what there is no time for is left out, and told.
    """

    seeds: int = 0
    tries_changes: bool = False


PLAIN = Extent()


@dataclass(frozen=True, slots=True)
class Update:
    """A version of a library function that the program holds at another one; `user` must see it."""

    library: UUID
    version: int
    user: Any

    def content(self, program: UUID) -> editor.ContentView:
        """Return what the program would hold."""
        return editor.get_updated_content(
            program_id=program, library=self.library, version=self.version, user=self.user
        )

    def facts(self) -> dict[str, Any]:
        """Return what is kept of it."""
        return {"library": str(self.library), "version": self.version}


@dataclass(frozen=True, slots=True)
class Asker:
    """For whom tests are carried out: their id, if they are known, and their name; `by_itself` for a named version."""

    person: int | None
    name: str
    by_itself: bool = False


def start_tests(
    *, program: UUID, asker: Asker, tests: Collection[UUID] | None = None, number: int | None = None,
    extent: Extent = PLAIN, update: Update | None = None,
) -> UUID:  # fmt: skip
    """Queue tests of a program, all or some, on what is drawn now, on a version, or on what an update would make of it.

    Returns the id of the run of them.

    Raises:
        NotFound: there is none, or one of them is gone.
        NotReady: the program has errors.
        TooManyRehearsals: the person or the site has as many as may wait or be under way.
        editor.NoSuchProgram: there is no such version, or no such function of the library.
        editor.BadRequest: the program does not hold the function.
    """
    rows = _find(program, tests)
    content = editor.get_content(program_id=program, number=number) if update is None else update.content(program)
    refuse_too_many(site=content.site, person=asker.person)  # before it is compiled: who asks too often costs little
    job = _job(content, rows) | {"seeds": extent.seeds, "changes": MOST_CHANGES if extent.tries_changes else 0}
    with transaction.atomic():
        return _put(content, rows, asker, job, whole=tests is None, update=update.facts() if update else None)


def _find(program: UUID, tests: Collection[UUID] | None) -> list[ProgramTest]:
    found = ProgramTest.objects.filter(program=program).order_by("created_at", "name")
    rows = list(found if tests is None else found.filter(pk__in=tests))
    if not rows:
        raise NotFound(NO_TESTS)
    if tests is not None and len(rows) < len(set(tests)):
        raise NotFound("One of these tests is not beside the program any more. Read the list again.")
    return rows


def _job(content: editor.ContentView, tests: Sequence[ProgramTest]) -> dict[str, Any]:
    compiled = editor.compile_content(content=content)
    if compiled.plan is None:
        raise not_ready(compiled.errors)
    site = digests_of(content.site)  # before the scene: what changes in between makes results stale
    return {
        "site": site,
        "plan": json.loads(compiled.plan),
        "numbers": compiled.compiled()["numbers"],
        "scene": _scene(content.site),
        "tests": [{"id": str(row.pk), "revision": row.revision, "text": row.text} for row in tests],
    }


def _scene(site: str) -> dict[str, Any]:
    """Return the site as it is described, not as it stands at this moment: a test comes out the same tomorrow."""
    devices = registry.list_devices(site=site, lifecycle="approved")
    places = [place_facts(place) for place in registry.list_places(site=site)]
    grid, paces = registry.get_map(site=site, to_plan=True).grid, find_paces(site=site)
    idless = frozenset(device.id for device in devices if device.is_of_paper)
    scene = Scene(grid=grid, devices=[device.at_home for device in devices], paces=paces, idless=idless)
    return scene_to_json(scene, places, editor.find_zones(site=site))


def _put(
    content: editor.ContentView, tests: Sequence[ProgramTest], asker: Asker, job: dict[str, Any], **columns: Any
) -> UUID:
    """Queue tests, in the caller's transaction."""
    rehearsal = put_into_queue(
        site=content.site, person=asker.person, kind=Rehearsal.Kind.TESTS, program=content.program,
        program_name=content.name, job=job, started_by=asker.name,
    )  # fmt: skip
    asked = {"seeds": job.get("seeds", 0), "tries_changes": bool(job.get("changes"))}
    return _note(content, tests, asker, rehearsal=rehearsal, site=job["site"], **asked, **columns)


def _note(content: editor.ContentView, tests: Sequence[ProgramTest], asker: Asker, **columns: Any) -> UUID:
    row = TrialRun.objects.create(
        program_id=content.program, number=content.number, digest=content.digest, started_by=asker.name,
        by_itself=asker.by_itself, total=len(tests), created_at=datetime.now(UTC), **columns,
    )  # fmt: skip
    say_changed(content.program)
    return row.pk


def queue_named_versions() -> int:
    """Queue the tests of versions that were named; those for which there is no room now wait. Returns how many."""
    return sum(_queue_version(each) for each in editor.list_versions_to_test(most=VERSIONS_AT_ONCE))


def _queue_version(named: editor.VersionToTestView) -> bool:
    tests = list(ProgramTest.objects.filter(program=named.program).order_by("created_at", "name"))
    if not tests:
        return _take(named, lambda: None)
    asker = Asker(named.person, named.by, by_itself=True)
    try:
        content = editor.get_content(program_id=named.program, number=named.number)
        refuse_too_many(site=content.site, person=named.person)
        job = _job(content, tests)
        return _take(named, lambda: _put(content, tests, asker, job, whole=True))
    except TooManyRehearsals:
        return False
    except NotReady as error:
        why = {"reason": error.detail[:500], "ended_at": datetime.now(UTC)}
        return _take(named, lambda: _note(content, tests, asker, whole=True, **why))
    except VipoError as error:
        log.warning("The tests of version %s of %s cannot be queued: %s", named.number, named.program, error.detail)
        return _take(named, lambda: None)


def _take(named: editor.VersionToTestView, act: Callable[[], object]) -> bool:
    """Take a version on and act, both or neither; False when somebody else has taken it."""
    with transaction.atomic():
        taken = editor.take_version_to_test(version=named.version)
        if taken:
            act()
    return taken
