"""What came of a program's tests: for each its last result, what is under way, and which ways were taken."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any
from uuid import UUID

from django.db.models import QuerySet

from editor import services as editor
from execution.errors import NotFound
from execution.models import MeantChange, ProgramTest, Rehearsal, TrialResult, TrialRun
from execution.program_tests.meant_changes import ChangeKey, find_meant, mark_of
from execution.program_tests.site_digests import Digests, digests_of, what_changed
from execution.program_tests.stored_tests import MOST_TESTS, tag_of
from execution.reasons import cause_of
from execution.rehearsals.rehearsals import HEAVY
from execution.trials.coverage import ProgramPath, coverage_to_json
from execution.trials.refusals import cause_of_refusal

MOST_RUNS = 500
RUNS_LOOKED_AT = 20
Key = tuple[int, UUID, str]
"""A result, its test, and the digest of what it was carried out on."""
Latest = Mapping[UUID, TrialResult]


def show_tests(*, program: UUID, asker: int) -> dict[str, Any]:
    """Return a program's tests with their last results, as JSON (`ProgramTestsShape`). Raises NoSuchProgram."""
    content = editor.get_content(program_id=program)
    digest = content.digest
    site = digests_of(content.site)
    rows = ProgramTest.objects.filter(program=program).select_related("edited_by").defer("text")
    tests = list(rows.order_by("created_at", "name"))
    known = TrialResult.objects.filter(test__program=program, run__update__isnull=True).order_by("-at", "-pk")
    results = list(known.values_list("pk", "test", "digest"))
    latest = _latest(results)
    runs = list(runs_of(program).filter(update__isnull=True)[:RUNS_LOOKED_AT])
    under_way = [run for run in runs if status_of(run) in Rehearsal.OPEN]
    over = next((run for run in runs if status_of(run) not in Rehearsal.OPEN), None)
    return {
        "most": MOST_TESTS,
        "tests": [_test_to_json(test, latest.get(test.pk), digest, site) for test in tests],
        "under_way": [run_to_json(run, asker) for run in reversed(under_way)],
        "last": run_to_json(over, asker) if over else None,
        "coverage": _coverage(program, results, digest),
        "changes": _changes(program, tests, digest, content.document),
    }


def runs_of(program: UUID) -> QuerySet[TrialRun]:
    """Return the runs of a program's tests, the newest first, without what of their place in the queue is large."""
    rows = TrialRun.objects.filter(program=program).select_related("rehearsal").order_by("-created_at")
    return rows.defer("ways", *(f"rehearsal__{column}" for column in HEAVY))


def status_of(run: TrialRun) -> str:
    """Return how a run of tests stands: what its place in the queue says, once it is over by itself."""
    if run.ended_at is not None:
        return str(Rehearsal.Status.FAILED if run.reason else Rehearsal.Status.DONE)
    return str(run.rehearsal.status if run.rehearsal else Rehearsal.Status.FAILED)


def run_to_json(run: TrialRun, asker: int) -> dict[str, Any]:
    """Return a run of tests as JSON (`TestRunShape`)."""
    rehearsal = run.rehearsal
    reason = run.reason or (rehearsal.reason if rehearsal else "")
    ended = run.ended_at or (rehearsal.ended_at if rehearsal else None)
    return {
        "id": run.pk,
        "rehearsal": rehearsal.pk if rehearsal else None,
        "number": run.number,
        "status": status_of(run),
        "passed": run.passed,
        "total": run.total,
        "seeds": run.seeds,
        "tries_changes": run.tries_changes,
        "by_itself": run.by_itself,
        "started_by": run.started_by,
        "mine": bool(rehearsal and rehearsal.person == asker),
        "reason": reason,
        "cause": cause_of(reason),
        "created_at": run.created_at,
        "ended_at": ended,
    }


def show_run(*, program: UUID, run: UUID, asker: int) -> dict[str, Any]:
    """Return a run of tests with what came of each, as JSON (`WholeTestRunShape`). Raises NotFound."""
    row = runs_of(program).filter(pk=run).first()
    if row is None:
        raise NotFound("There is no such run of tests. Its results may be too old to be kept.")
    results = row.results.select_related("test").defer("taken", "test__text").order_by("test__created_at", "test__name")
    shown = [_line_of_run(each) for each in results]
    return {**run_to_json(row, asker), "update": row.update, "results": shown}


def _line_of_run(result: TrialResult) -> dict[str, Any]:
    told = {"id": result.test_id, "name": result.test.name, "status": result.status}
    return {**told, "seed": result.seed, "duration_s": result.duration_s, **_detail(result)}


def _detail(result: TrialResult) -> dict[str, Any]:
    return {**result.detail, "cause": cause_of_refusal(result.detail["why"])}


def _test_to_json(test: ProgramTest, result: TrialResult | None, digest: str, site: Digests) -> dict[str, Any]:
    return {
        "id": test.pk,
        "name": test.name,
        "tag": tag_of(test.revision),
        "edited_at": test.edited_at,
        "edited_by": test.edited_by.display_name if test.edited_by else "",
        "result": None if result is None else _result_to_json(result, test, digest, site),
    }


def _result_to_json(result: TrialResult, test: ProgramTest, digest: str, site: Digests) -> dict[str, Any]:
    change = what_changed(result.run.site, site)
    is_older = "program" if result.digest != digest else "test" if result.revision != test.revision else None
    return {
        "status": result.status,
        "stale": is_older or ("site" if change else None),
        "site_change": change,
        "number": result.run.number,
        "digest": result.digest,
        "seed": result.seed,
        "duration_s": result.duration_s,
        "at": result.at,
        **_detail(result),
    }


def _changes(
    program: UUID, tests: Sequence[ProgramTest], digest: str, document: Mapping[str, Any]
) -> dict[str, Any] | None:
    """Return which changes of the program no test noticed when they were tried last."""
    run = TrialRun.objects.filter(program=program, changes__isnull=False).order_by("-created_at").first()
    if run is None:
        return None
    found = dict(run.changes or {})
    tried_with = found.pop("tests")
    is_same = run.digest == digest and tried_with == sorted([str(test.pk), test.revision] for test in tests)
    meant = find_meant(program=program)
    unnoticed = [_unnoticed_to_json(each, meant, document) for each in found["unnoticed"]]
    return {**found, "unnoticed": unnoticed, "stale": not is_same, "number": run.number, "at": run.ended_at}


def _unnoticed_to_json(
    change: Mapping[str, Any], meant: Mapping[ChangeKey, MeantChange], document: Mapping[str, Any]
) -> dict[str, Any]:
    key = ChangeKey(change["step"], change["code"], change["name"])
    mark, said = mark_of(key, document), meant.get(key)
    holds = said if said is not None and said.mark == mark else None
    return {
        **change,
        "mark": mark,
        "meant_at": holds.at if holds else None,
        "meant_by": holds.by.display_name if holds and holds.by else "",
    }


def _latest(results: Sequence[Key]) -> Latest:
    """Return the last result of each test."""
    rows = TrialResult.objects.select_related("run").defer("taken").in_bulk(list(_newest(results).values()))
    return {row.test_id: row for row in rows.values()}


def _newest(results: Iterable[Key]) -> dict[UUID, int]:
    """Return for each test the first of its results."""
    found: dict[UUID, int] = {}
    for key, test, _ in results:
        found.setdefault(test, key)
    return found


def _coverage(program: UUID, results: Sequence[Key], digest: str) -> dict[str, Any] | None:
    """Return which ways the tests took through the program as it is now, else as it was when they last ran."""
    runs = TrialRun.objects.filter(program=program, update__isnull=True).exclude(ways=[]).order_by("-created_at")
    run = runs.filter(digest=digest).first() or runs.first()
    if run is None:
        return None
    chosen = _newest(each for each in results if each[2] == run.digest).values()
    found = list(TrialResult.objects.filter(pk__in=list(chosen)).values_list("taken", flat=True))
    taken = Counter((step, name) for each in found for step, name in each)
    ways = [ProgramPath(each["step"], each["line"], each["name"]) for each in run.ways]
    constructs = [{key: each[key] for key in ("step", "line", "ways")} for each in coverage_to_json(ways, taken, {})]
    return {"stale": run.digest != digest, "tests": len(found), "constructs": constructs}


def list_version_tests(*, program: UUID) -> list[dict[str, Any]]:
    """Return for each version on whose content all tests were carried out the last such run, the newest version first.

    As JSON (`VersionTestsShape`).
    """
    newest: dict[str, TrialRun] = {}
    for run in runs_of(program).filter(whole=True, update__isnull=True)[:MOST_RUNS]:
        newest.setdefault(run.digest, run)
    numbers = editor.find_numbers(program_id=program, digests=newest)
    return [_version_to_json(number, newest[digest]) for number, digest in sorted(numbers.items(), reverse=True)]


def _version_to_json(number: int, run: TrialRun) -> dict[str, Any]:
    return {
        "number": number,
        "status": status_of(run),
        "passed": run.passed,
        "total": run.total,
        "created_at": run.created_at,
    }
