"""A crowded library: how soon words find functions among 10,000, and how soon one is compared and its users told.

Measured over Django's test client, on SQLite and on PostgreSQL: what the network takes is not in it.
"""

from __future__ import annotations

import json
import random
import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

from bench.figures import best_ms, figure

FUNCTIONS = 10_000
QUERIES = ("mix paint", "mischen", "carry box oven", "transportieren", "zzz", "")
_VERBS = ("fetch", "mix", "cure", "press", "wash", "weigh", "sort", "pack", "scan", "drill")
_THINGS = ("Box", "Paint", "Pallet", "Can", "Door", "Shelf", "Sample", "Order", "Part", "Tray")
ROOT = Path(__file__).resolve().parents[2]


def measure() -> Iterator[dict[str, object]]:
    """Fill a library in each database and ask it."""
    from django.core.management import call_command
    from django.test.utils import override_settings

    from tests.kit.files import copy_migrated
    from tests.kit.servers import run_postgres
    from vipo_site.settings import postgres

    with override_settings(ALLOWED_HOSTS=["*"]), tempfile.TemporaryDirectory() as folder:
        copy_migrated(Path(folder) / "db.sqlite3")
        _use({"NAME": str(Path(folder) / "db.sqlite3")})
        yield from _asked("SQLite")
        with run_postgres(Path(folder)) as server:
            _use(postgres(server.url))
            call_command("migrate", verbosity=0)
            yield from _asked("PostgreSQL")
            _use({})


def _use(settings: dict[str, Any]) -> None:
    from django.db import connections

    connections["default"].close()
    connections.databases["default"] = {**connections.databases["default"], **settings}
    del connections["default"]


def _asked(database: str) -> Iterator[dict[str, object]]:
    from django.db import connection
    from django.test import Client

    from registry import services as registry

    registry.create_site(name="Hall", slug="hall")
    author = registry.create_user(email="ada@vipo.example", password="a long password", display_name="Ada Author")
    registry.set_member(site="hall", email="ada@vipo.example", role="author")
    _fill(author)
    with connection.cursor() as cursor:
        cursor.execute("ANALYZE")  # as databases do by themselves, some time after so much was written
    client = Client()
    client.force_login(author)
    for query in QUERIES:
        found = client.get("/api/library", {"q": query, "limit": 50, "fits": "hall"})
        assert found.status_code == 200, found.content
        took = best_ms(partial(client.get, "/api/library", {"q": query, "limit": 50, "fits": "hall"}))
        what = f"the first 50 of {FUNCTIONS} functions that are found by “{query}”"
        yield figure(what, took, "ms", wanted=100, found=len(found.json()), database=database)
    first = client.get("/api/library", {"limit": 1}).json()[0]["id"]
    took = best_ms(lambda: client.get(f"/api/library/{first}/comparison?old=1&new=1"))
    yield figure("two versions of a function compared", took, "ms", database=database)
    took = best_ms(lambda: client.get(f"/api/library/{first}/uses"))
    yield figure("who holds a function", took, "ms", database=database)


def _fill(author: Any) -> None:
    """Write the functions as saving writes them, from those of the demo under made-up names and descriptions."""
    from editor.language.signatures.signature import signature_of
    from editor.language.site.signature import signature_to_json
    from editor.library.words import words_of
    from editor.models import LibraryFunction, LibraryVersion
    from registry import services as registry

    chance = random.Random(0)
    examples = json.loads((ROOT / "examples" / "library" / "painting-factory.json").read_text())["functions"]
    known = [(each["versions"][-1], signature_of(each["versions"][-1], {})) for each in examples]
    site_id = registry.get_site_id(site="hall")
    functions, versions = [], []
    for number in range(FUNCTIONS):
        definition, signature = known[number % len(known)]
        name = f"{chance.choice(_VERBS)}{chance.choice(_THINGS)}{number}"
        said = " ".join(chance.choice((*_VERBS, *_THINGS)).lower() for _ in range(20))
        row = LibraryFunction(site_id=site_id, name=name, description=said, author=author, last_version=1)
        row.found_by = words_of(name, said, definition, signature, {})
        functions.append(row)
        versions.append(
            LibraryVersion(
                function=row,
                number=1,
                author=author,
                definition=definition,
                script="def run(self):\n    pass\n" * 20,
                signature=signature_to_json(signature),
            )
        )
    LibraryFunction.objects.bulk_create(functions, batch_size=500)
    LibraryVersion.objects.bulk_create(versions, batch_size=500)
