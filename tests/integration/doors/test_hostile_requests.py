"""What a hostile client puts into every field of every call: never a failure of ours, and nothing of it is kept.

The calls and their fields are those of the API's own description, so that a new one is tried without a word here.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any
from urllib.parse import quote
from uuid import uuid4

import pytest
from django.apps import apps
from django.db import connection, models
from django.test import Client

from editor import services as editor
from tests.kit.files import ROOT
from tests.kit.sign_in import signed_in
from tests.kit.sites import make_hall, make_mixers

API = json.loads((ROOT / "docs" / "openapi.json").read_text())
CALLS = [
    (method, path, call)
    for path, calls in sorted(API["paths"].items())
    for method, call in sorted(calls.items())
    if (call.get("parameters") or "requestBody" in call)
    and not path.endswith(
        ("/sign-out", "/sign-out-everywhere", "/mtconnect/current", "/mtconnect/sample", "/things/events")
    )
]
"""All calls that are told anything, but for those that may go on without an end."""
MARK = "poisoned"
TEXTS = {
    "NUL": f"{MARK}\0",
    "a control character": f"{MARK}\x07",
    "half of a surrogate pair": f"{MARK}\ud800",
    "a mark that turns the order": f"{MARK}\u202e",
    "very long": MARK * 20_000,
}
OTHERS = {
    "NaN": float("nan"), "Infinity": float("inf"), "a huge number": 10**400, "a large number": 10**18, "true": True,
    "a list": [[]], "an object": {"a": {}}, "null": None, "nested": json.loads("[" * 60 + "]" * 60),
}  # fmt: skip
HARD_FOR_DATABASES = {"NUL", "half of a surrogate pair", "very long", "a huge number", "a large number"}
ON_POSTGRESQL = os.environ.get("VIPO_TEST_DATABASE", "").startswith("postgres")
POISONS = {
    what: poison for what, poison in {**TEXTS, **OTHERS}.items() if not ON_POSTGRESQL or what in HARD_FOR_DATABASES
}
"""On PostgreSQL, where all of this runs a second time, those that one database may take and another not."""
TURNS = (6 if ON_POSTGRESQL else 3) if os.environ.get("VIPO_STEADY") == "1" else 1
"""Where a change is judged, each place of a call is told one poison in so many, and the place after it the next one."""
pytestmark = pytest.mark.django_db


@pytest.fixture
def admin(db: None) -> Client:
    make_hall()
    make_mixers("mixer1")
    client = signed_in("admin")
    client.raise_request_exception = False
    return client


def known_values() -> dict[str, str]:
    """Return what stands in a path so that the call gets as far as it can."""
    program = str(editor.create_program(site="hall", name="Task").id)
    names = {"slug": "hall", "site": "hall", "device_id": "mixer1", "device": "mixer1", "thing": "mixer1"}
    return {**names, "program": program, "number": "1", "alert_id": "1"}


def address(path: str, known: dict[str, str], **instead: str) -> str:
    names = [part[1:-1] for part in path.replace(".", "/").split("/") if part.startswith("{")]
    values = {name: known.get(name, str(uuid4())) for name in names} | instead
    return path.format(**{name: quote(value, safe="", errors="surrogatepass") for name, value in values.items()})


def resolved(schema: dict[str, Any]) -> dict[str, Any]:
    while "$ref" in schema:
        schema = API["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
    for several in ("anyOf", "allOf", "oneOf"):
        for choice in schema.get(several, ()):
            if choice.get("type") != "null":
                return resolved(choice)
    return schema


def example(schema: dict[str, Any], depth: int = 0) -> Any:
    """Return a value that has the shape, with all its fields."""
    schema = resolved(schema)
    if "enum" in schema:
        return schema["enum"][0]
    if schema.get("type") == "object" or "properties" in schema:
        return {n: example(s, depth + 1) for n, s in schema.get("properties", {}).items()} if depth < 4 else {}
    if schema.get("format") == "uuid":
        return str(uuid4())
    kinds = {"string": "a", "integer": 1, "number": 1.0, "boolean": True, "array": []}
    if schema.get("type") == "array" and "items" in schema and depth < 4:
        return [example(schema["items"], depth + 1)]
    return kinds.get(schema.get("type", ""), "a")


def poisoned(value: Any, poison: Any) -> Iterator[Any]:
    """Yield the value with the poison in the place of each of its fields, and beside them, in turn."""
    yield poison
    if isinstance(value, dict):
        for name, inner in value.items():
            for other in poisoned(inner, poison):
                yield {**value, name: other}
        yield {**value, "unknown": poison}
        yield {**value, poison if isinstance(poison, str) else "unknown": 1}
    elif isinstance(value, list):
        for number, inner in enumerate(value):
            for other in poisoned(inner, poison):
                yield [*value[:number], other, *value[number + 1 :]]


def kept_texts() -> str:
    """Return all that the database holds in words."""
    found = []
    for model in apps.get_models():
        words = [
            f.attname
            for f in model._meta.concrete_fields
            if isinstance(f, models.TextField | models.CharField | models.JSONField)
        ]
        found += [str(row) for row in model._default_manager.values_list(*words)] if words else []
    return "\n".join(found)


@pytest.mark.parametrize(("method", "path", "call"), CALLS, ids=[f"{m} {p}" for m, p, _ in CALLS])
def test_no_field_of_a_call_takes_what_it_cannot_keep(
    admin: Client, method: str, path: str, call: dict[str, Any]
) -> None:
    known = known_values()
    tried = []
    for turn, (what, poison) in enumerate(POISONS.items()):
        for number, (said, ask) in enumerate(attempts(admin, method, path, call, known, poison)):
            if (number + turn) % TURNS:
                continue
            answer = ask()
            assert answer.status_code < 500 or answer.status_code == 501, (what, said, answer.content[:400])
            tried.append(answer.status_code)
    assert tried
    assert MARK not in kept_texts()


def attempts(
    client: Client, method: str, path: str, call: dict[str, Any], known: dict[str, str], poison: Any
) -> Iterator[tuple[str, Callable[[], Any]]]:
    """Yield what is said with the poison in each place in turn, and what asks it."""
    text = poison if isinstance(poison, str) else json.dumps(poison)
    for parameter in call.get("parameters", []):
        if parameter["in"] == "path":
            where = address(path, known, **{parameter["name"]: text[:3000]})
            yield parameter["name"], partial(send, client, method, where)
        elif parameter["in"] == "query":
            query = f"?{parameter['name']}={quote(text[:3000], errors='surrogatepass')}"
            yield parameter["name"], partial(send, client, method, address(path, known) + query)
    content = call.get("requestBody", {}).get("content", {})
    if "application/json" in content:
        for body in poisoned(example(content["application/json"]["schema"]), poison):
            told = json.dumps(body)
            yield told[:300], partial(send, client, method, address(path, known), told)
    elif "text/plain" in content:
        body = text.encode(errors="surrogatepass")
        where = address(path, known)
        yield "body", partial(client.generic, method.upper(), where, body, content_type="text/plain")
    elif content:
        form = example(next(iter(content.values()))["schema"])
        for name in form:
            fields = {**form, name: text.encode(errors="surrogatepass")}
            yield name, partial(client.generic, method.upper(), address(path, known), **form_of(fields))


def form_of(fields: dict[str, Any]) -> dict[str, Any]:
    parts = [
        b'--x\r\nContent-Disposition: form-data; name="%s"\r\n\r\n%s\r\n'
        % (name.encode(), value if isinstance(value, bytes) else str(value).encode())
        for name, value in fields.items()
    ]
    return {"data": b"".join([*parts, b"--x--\r\n"]), "content_type": "multipart/form-data; boundary=x"}


def send(client: Client, method: str, where: str, body: str | None = None) -> Any:
    kept = {"data": body.encode(), "content_type": "application/json"} if body is not None else {}
    return client.generic(method.upper(), where, **kept)


@pytest.mark.parametrize("value", ["a\\000b", "\\007", "a b"])
def test_a_cookie_that_is_no_text_is_a_stranger(db: None, value: str) -> None:
    client = Client(raise_request_exception=False)
    answer = client.get("/api/sites", HTTP_COOKIE=f'sessionid="{value}"; csrftoken="{value}"')
    assert (answer.status_code, answer.json()["code"]) == (401, "signed_out")


def test_the_database_is_the_one_that_was_asked_for(db: None) -> None:
    assert connection.vendor == ("postgresql" if ON_POSTGRESQL else "sqlite")
