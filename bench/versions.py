"""Long histories: how much a version takes, how soon a list and any version are there, two of them compared; restores.

The program has 1,000 steps with ids as browsers make them, and its versions differ as an hour of drawing makes them.
"""

from __future__ import annotations

import json
import random
import tempfile
import uuid
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from bench.figures import best_cpu_ms, best_ms, figure
from bench.programs import make_program

Json = dict[str, Any]
STEPS, VERSIONS, MADE, OPENED, SEQUENCES, RESTORES = 1000, 10_000, 1000, 60, 10_000, 1000
MOST_EDITS = 40


def measure() -> Iterator[dict[str, object]]:
    """Measure on SQLite, in this process and over Django's test client: what the network takes is not in it."""
    yield from measure_laws()
    yield from measure_comparing()
    with tempfile.TemporaryDirectory() as folder:
        yield from measure_history(Path(folder))


def drawn_program(steps: int, chance: random.Random) -> Json:
    """Return a sound program whose ids and positions are as people's browsers make them."""
    document = make_program(steps)
    names = {step: uuid.UUID(int=chance.getrandbits(128)).hex[:12] for step in document["steps"]}
    renamed = {}
    for step, body in document["steps"].items():
        parent, branch, order = body["place"]
        pos = [round(chance.uniform(0, 20), 2), round(chance.uniform(-12, 0), 2)]
        renamed[names[step]] = {**body, "place": [names.get(parent, parent), branch, order], "pos": pos}
    return {**document, "steps": renamed}


def edited(document: Json, chance: random.Random, edits: int) -> Json:
    """Return the program after so many edits: values typed and chips shifted."""
    steps = dict(document["steps"])
    for name in chance.sample([*steps], edits):
        body = steps[name]
        if body["kind"] == "wait" and "duration" in body["params"]:
            steps[name] = {**body, "params": {"duration": chance.randrange(900)}}
        else:
            steps[name] = {**body, "pos": [round(chance.uniform(0, 20), 2), round(chance.uniform(-12, 0), 2)]}
    return {**document, "steps": steps}


def measure_laws() -> Iterator[dict[str, object]]:
    """Try the laws on chance: a difference applied, and restores while five people draw."""
    from editor.language.comparison.changes import apply_changes, is_same
    from editor.language.comparison.difference import compare
    from tests.kit.drawn.edits import edited as edited_by_chance
    from tests.kit.drawn.edits import empty
    from tests.kit.drawn.restores import lost_in_a_restore

    wrong = 0
    for seed in range(SEQUENCES):
        old = edited_by_chance(empty(), seed, seed % 40)
        new = edited_by_chance(old, -seed - 1, seed % 37)
        changes = compare(old, new).changes
        there = is_same(apply_changes(old, changes), new)
        back = is_same(apply_changes(new, [change.reversed() for change in changes]), old)
        wrong += not (there and back)
    yield figure("differences that do not give the other document", wrong, "sequences", of=SEQUENCES)
    lost = sum(bool(lost_in_a_restore(seed)) for seed in range(RESTORES))
    yield figure("restores in which somebody's edit was lost", lost, "restores", of=RESTORES, editors=5)


def measure_comparing() -> Iterator[dict[str, object]]:
    """Compare two programs: few edits apart, and with nothing in common."""
    from editor.language.comparison.difference import compare

    chance = random.Random(1)
    old = drawn_program(STEPS, chance)
    for what, other in (("few", edited(old, chance, 20)), ("all", drawn_program(STEPS, chance))):
        new = json.loads(json.dumps(other))  # as it comes from the database: no part of it is the same object
        took = best_cpu_ms(lambda new=new: compare(old, new), 20)
        yield figure("compare by construct", took, "ms", steps=STEPS, differ=what)


def measure_history(folder: Path) -> Iterator[dict[str, object]]:
    """Make many versions, list and open them, and ask for two of them compared."""
    from django.db import connections
    from django.test import Client
    from django.test.utils import override_settings

    from tests.kit.files import copy_migrated

    copy_migrated(folder / "db.sqlite3")
    with override_settings(ALLOWED_HOSTS=["*"]):
        connections["default"].settings_dict["NAME"] = str(folder / "db.sqlite3")
        connections["default"].close()
        program, versions = _make_versions()
        yield from _sizes(versions)
        client = Client()
        client.force_login(_author())
        yield from _asked(client, program)


def _author() -> Any:
    from registry import services as registry
    from registry.models import User

    found = User.objects.filter(email="ada@vipo.example").first()
    if found is None:
        found = registry.create_user(email="ada@vipo.example", password="a long password", display_name="Ada Author")
    return found


def _make_versions() -> tuple[str, Any]:
    from editor import services
    from editor.documents.shared_document import digest_of
    from editor.models import Version
    from editor.programs.checking import build_surroundings
    from editor.programs.compilations import print_program
    from editor.programs.packing import Content
    from editor.programs.versions import add_version
    from registry import services as registry

    registry.create_site(name="Hall", slug="hall")
    author = _author()
    registry.set_member(site="hall", email=author.email, role="author")
    chance = random.Random(2)
    document = drawn_program(STEPS, chance)
    program = str(services.create_program(site="hall", name="Long", document=document, user=author).id)
    script = print_program(document, build_surroundings(site="hall"))
    for number in range(MADE):
        document = edited(document, chance, chance.randrange(1, MOST_EDITS))
        content = Content(document, f"{script}# {number}\n")
        about = {"name": "", "message": "", "author": author, "cause": ""}
        add_version(program, content, digest_of(document), 0, about)
    _copy_versions(program)
    return program, Version.objects


def _copy_versions(program: str) -> None:
    """Fill the history up with copies of its versions, which take as much and are opened as they are."""
    from editor.models import Version

    made = list(Version.objects.filter(program_id=program).order_by("number"))
    for start in range(len(made), VERSIONS, len(made)):
        rows = [
            Version(
                program_id=program,
                number=start + at + 1,
                author_id=row.author_id,
                base_id=row.base_id,
                content=row.content,
                digest=row.digest,
            )
            for at, row in enumerate(made)
        ]
        Version.objects.bulk_create(rows, batch_size=200)


def _sizes(versions: Any) -> Iterator[dict[str, object]]:
    sizes = sorted(len(content) for content in versions.values_list("content", flat=True).iterator())
    whole = versions.filter(base=None).count()
    yield figure("bytes of a version", sum(sizes) / len(sizes) / 1000, "kB", versions=len(sizes), whole=whole)
    yield figure("bytes of the largest version", sizes[-1] / 1000, "kB")


def _asked(client: Any, program: str) -> Iterator[dict[str, object]]:
    address = f"/api/programs/{program}"

    def ask(path: str) -> Any:
        answer = client.get(address + path)
        assert answer.status_code == 200, answer.content
        return answer

    chance = random.Random(3)
    listed = len(ask("/versions?limit=50").content)
    yield _timed("list of 50 versions", [partial(ask, "/versions?limit=50")] * 9, bytes=listed)
    numbers = [chance.randrange(1, VERSIONS) for _ in range(OPENED)]
    yield _timed("open any version", [partial(ask, f"/versions/{number}") for number in numbers])
    pairs = [(chance.randrange(1, VERSIONS), chance.randrange(1, VERSIONS)) for _ in range(9)]
    asks = [partial(ask, f"/comparison?old={old}&new={new}") for old, new in pairs]
    yield _timed("compare over HTTP, both sides compiled", asks)


def _timed(what: str, asks: Sequence[Callable[[], object]], **more: object) -> dict[str, object]:
    """Return the slowest, as somebody waits for it, with the median and the slowest in processor time."""
    took = sorted(best_ms(each, 1) for each in asks)
    cpu = max(best_cpu_ms(each, 1) for each in asks)
    return figure(what, took[-1], "ms", median=round(took[len(took) // 2], 1), cpu_ms=round(cpu, 1), **more)
