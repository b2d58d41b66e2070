"""The shapes of what is asked and answered about tests of programs."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Any, Literal
from uuid import UUID

from ninja import Field, Schema
from pydantic import Strict, model_validator

from execution.program_tests.stored_tests import MOST_TESTS, MOST_TEXT
from execution.program_tests.test_runs import MOST_SEEDS
from execution.shapes import Cause, OfVersion
from registry.requests import Asked, Line

MOST_FILE = 1_000_000
Status = Literal["queued", "running", "done", "failed", "cancelled"]


class TestTextShape(Schema):
    """A test as it is written; `tag` is its ETag, by which it is written anew."""

    id: UUID
    name: str
    text: str
    tag: str


class ExpectationShape(Schema):
    """What a test expected, on which line of its text, and what was seen; `t_s` is when, in virtual time.

    `expected` and `saw` are English; `kind` with `says`, and `seen` with its `code`, are what sentences of other
    languages are made of (empty in results from before there were such). `figure` is what was measured.
    """

    expected: str
    line: int
    ok: bool
    saw: str
    t_s: float | None
    figure: float | None = None
    kind: str = ""
    says: Any = None
    seen: dict[str, Any] = {}


class SpanShape(Schema):
    """The least, the median, the 95th percentile and the most of what was measured."""

    least: float
    median: float
    p95: float
    most: float


class OddsShape(Schema):
    """What came of a test with `seeds` of the `asked` seeds from 1 on, as many as there was time for.

    So many `failed`, the first of them `failing`; the 95 % interval of that share is from `low` to `high`. `took_s`
    spans the virtual times of those that passed, `figures` what each expectation has measured.
    """

    asked: int
    seeds: int
    failed: int
    low: float
    high: float
    failing: list[int]
    took_s: SpanShape | None
    figures: list[SpanShape | None]


class SiteChange(Schema):
    """What of the site has changed since; `devices` are the ids of some of those that joined, left or differ."""

    what: Literal["map", "places", "zones", "devices"]
    devices: list[str]


class TestResultShape(Schema):
    """What came of a test: on which content of the program, with which seed, how long it took in virtual time.

    `stale` says what has changed since: the program, the test, or the site, of which `site_change` tells more. An
    unusable test names what there is not, on a `line` (0: unknown) and `why`; a stopped one was not done when the time
    for all was over.
    """

    status: Literal["passed", "failed", "unusable", "stopped"]
    stale: Literal["program", "test", "site"] | None
    site_change: SiteChange | None
    number: int | None
    digest: str
    seed: int
    duration_s: float
    at: datetime
    expectations: list[ExpectationShape]
    errors: list[str]
    line: int
    why: str
    cause: Cause | None
    odds: OddsShape | None = None


class ProgramTestShape(Schema):
    """A test beside a program, and its last result."""

    id: UUID
    name: str
    tag: str
    edited_at: datetime
    edited_by: str
    result: TestResultShape | None


class TestRunShape(Schema):
    """Tests carried out together, on a version or on what was drawn (no `number`).

    `rehearsal` is what they are in the queue, by which they are followed and cancelled; `by_itself` is true where they
    are those of a version that was named. Each was carried out with so many `seeds` besides its own; `tries_changes`
    says whether changes of the program were tried.
    """

    id: UUID
    rehearsal: UUID | None
    number: int | None
    status: Status
    passed: int
    total: int
    seeds: int
    tries_changes: bool
    by_itself: bool
    started_by: str
    mine: bool
    reason: str
    cause: Cause | None
    created_at: datetime
    ended_at: datetime | None


class UpdateShape(Schema):
    """A function of the library and a version of it."""

    library: UUID
    version: int


class TestRunResultShape(Schema):
    """What came of a test in one run of tests: what was expected and not seen, or what there is not."""

    id: UUID
    name: str
    status: Literal["passed", "failed", "unusable", "stopped"]
    seed: int
    duration_s: float
    expectations: list[ExpectationShape]
    errors: list[str]
    line: int
    why: str
    cause: Cause | None


class WholeTestRunShape(TestRunShape):
    """A run of tests with what came of each, once it is over; tests that were deleted since are left out."""

    update: UpdateShape | None
    results: list[TestRunResultShape]


class CoveredConstruct(Schema):
    """A construct, its line of the script, and for each way through it how many tests took it."""

    step: str
    line: int
    ways: dict[str, int]


class CoverageShape(Schema):
    """Which ways through the program so many tests took; `stale` if that was before the program was changed."""

    stale: bool
    tests: int
    constructs: list[CoveredConstruct]


class UnnoticedChange(Schema):
    """A change of the program that no test notices: at a step (its id, empty for a role) and a line of the script.

    `code` is what was changed, `name` of which role; `reached` tells whether any test comes there at all. `mark` stands
    for what the step does now; `meant_by` is who has said of that step that it is meant so, at `meant_at`.
    """

    step: str
    line: int
    code: str
    name: str
    reached: bool
    mark: str
    meant_at: datetime | None
    meant_by: str


class ChangesShape(Schema):
    """Which changes of a program no test notices: how many `there_are`, were `tried` and `noticed`, and the others.

    `stale` says that the program or a test has changed since. `why` is empty, or why none was tried: a test is
    `failing`. `out_of_time` is true where the time ended before all were tried.
    """

    stale: bool
    number: int | None
    at: datetime | None
    there_are: int
    tried: int
    noticed: int
    unnoticed: list[UnnoticedChange]
    why: Literal["", "failing"]
    out_of_time: bool


class ProgramTestsShape(Schema):
    """The tests of a program, at most `most`; the runs of them that are under way, and the last that is over.

    `changes` is what came of trying changes of the program last, if anybody has.
    """

    most: int
    tests: list[ProgramTestShape]
    under_way: list[TestRunShape]
    last: TestRunShape | None
    coverage: CoverageShape | None
    changes: ChangesShape | None


class VersionTestsShape(Schema):
    """How the last run of all tests on a version's content stands."""

    number: int
    status: Status
    passed: int
    total: int
    created_at: datetime


class TestToWrite(Asked):
    """The text of a test: one entry of `tests`, as docs/testing-programs.md has it."""

    text: str = Field(max_length=MOST_TEXT)


class TestsToImport(Asked):
    """A file of tests, as `vipo test` reads it; the program and the site that it names are not looked at."""

    text: str = Field(max_length=MOST_FILE)


class LineFault(Schema):
    """Why a text is no test, and on which line (0: unknown); `cause` says it in other languages."""

    line: int
    why: str
    cause: Cause | None


class TestLookShape(Schema):
    """What is wrong with the text of a test, if anything."""

    fault: LineFault | None


class FirstTextShape(Schema):
    """The text that a new test begins with; `of_rehearsal` is whether it is made of the program's last rehearsal."""

    text: str
    of_rehearsal: bool


class MeantChangeToSay(Asked):
    """That it is meant so that no test notices a change, or that it is not; as the change is listed, with its mark."""

    step: Line = Field("", max_length=100)
    code: Line = Field(max_length=40)
    name: Line = Field("", max_length=200)
    mark: Line = Field("", max_length=32)
    meant: bool


class UpdateToTry(Asked):
    """A function of the library that the program holds, and the version of it with which the program is tried."""

    library: UUID
    version: Annotated[int, Strict(), Field(ge=1, lt=2**31)]


class TestsToRun(Asked):
    """Which tests are carried out (all, if none are named), on which version (what is drawn now, if none).

    With `update` on what is drawn now as it would be with that; what comes of it is told of that run of tests alone.

    With so many `seeds`, 1, 2, 3 and so on, besides its own each; `changes` of the program are tried once all pass. All
    of it has the time of one rehearsal.
    """

    tests: list[UUID] | None = Field(None, min_length=1, max_length=MOST_TESTS)
    version: OfVersion = None
    seeds: int = Field(0, ge=0, le=MOST_SEEDS)
    changes: bool = False
    update: UpdateToTry | None = None

    @model_validator(mode="after")
    def _one_content(self) -> TestsToRun:
        if self.update is not None and (self.version is not None or self.changes):
            raise ValueError("An update is tried on what is drawn now, without other changes: leave the others out.")
        return self
