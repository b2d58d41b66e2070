"""SPARQL over a site: each query runs in a process of its own, which is ended when it takes too much."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from django.conf import settings

from registry.bounds.slots import Claim, Slots
from registry.devices.queries import list_devices
from registry.devices.views import DeviceView
from registry.errors import RegistryError
from registry.processes.children import sigint_blocked
from vipo_device.protocol.description import description_to_json

CPU_S = 5
WALL_S = 30.0
MEMORY_BYTES = 1024 * 1024 * 1024
MOST_QUERY_CHARACTERS = 16_384
PATIENCE_S = 10.0
ANSWERED, REFUSED, TOO_LARGE = 0, 3, 4
"""The exit codes of registry/sparql/engine.py, which is never imported here: rdflib stays out of the server."""
_slots = Slots(in_all=2, of_site=1, of_person=1, most_waiting=2)
"""So a site with many questions leaves one of the two slots to the others."""


class BadQuery(RegistryError):
    """A query that is none, or that asks for what is not answered."""

    code = "bad_query"
    status = 400


class QueryTooLarge(RegistryError):
    """A query that takes too long, too much memory, or gives too much."""

    code = "query_too_large"
    status = 422


class TooManyQueries(RegistryError):
    """Others' queries are under way."""

    code = "too_many_queries"
    status = 429


@dataclass(frozen=True, slots=True)
class QueryAnswer:
    """A result as it is sent."""

    media_type: str
    body: bytes


def run_query(*, site: str, query: str, forms: Sequence[str] = (), person: int = 0) -> QueryAnswer:
    """Answer a person's query over a site's devices in the first form that can hold the result, or (none given) in any.

    Forms are `json`, `xml`, `csv`, `turtle`, `n-triples` and `json-ld`.

    Raises:
        BadQuery: it is no query, reaches out of the site, or cannot be answered in these forms.
        QueryTooLarge: it took too long or too much memory, or its result is too large.
        TooManyQueries: others are under way, of this person, at this site, or in all.
    """
    if not query.strip() or len(query) > MOST_QUERY_CHARACTERS:
        raise BadQuery(f"A query has 1 to {MOST_QUERY_CHARACTERS} characters. Give it as `query`.")
    devices = [_device(view) for view in list_devices(site=site)]
    job = {"query": query, "forms": list(forms), "devices": devices, "cpu_s": CPU_S, "memory_bytes": MEMORY_BYTES}
    refusal = TooManyQueries("Other queries are still being answered. Try again in a moment.")
    with _slots.held(Claim(person, site), refusal, patience_s=PATIENCE_S):
        code, output = _run(json.dumps(job).encode())
    return _read(code, output)


def _run(job: bytes) -> tuple[int, bytes]:
    """Run the engine on a job; return its exit code and what it said. It is gone when this returns."""
    command = [sys.executable, "-m", "registry.sparql.engine"]
    environment = {"PYTHONPATH": str(settings.BASE_DIR), "PYTHONUTF8": "1"}
    with sigint_blocked():
        engine = subprocess.Popen(  # noqa: S603 - our own module; the query goes to its standard input
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=environment,
            cwd=settings.BASE_DIR,
        )
    with engine as process:
        try:
            output, _ = process.communicate(job, timeout=WALL_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            return -signal.SIGXCPU, b""
    return process.returncode, output


def _read(code: int, output: bytes) -> QueryAnswer:
    if code == ANSWERED:
        media_type, _, body = output.partition(b"\n")
        return QueryAnswer(media_type.decode(), body)
    if code == REFUSED:
        raise BadQuery(output.decode(errors="replace"))
    if code == TOO_LARGE:
        raise QueryTooLarge(output.decode(errors="replace"))
    if code in (-signal.SIGXCPU, -signal.SIGKILL):
        raise QueryTooLarge(f"The query takes longer than {CPU_S} s. Ask for less at once.")
    raise QueryTooLarge("The query needs more memory than it may have. Ask for less at once.")


def _device(view: DeviceView) -> dict[str, Any]:
    return {
        "description": description_to_json(view.played),
        "status": view.status,
        "lifecycle": view.lifecycle,
        "online": view.online,
        "done": view.done,
        "last_seen_at": view.last_seen_at.isoformat() if view.last_seen_at else None,
        "values": dict(view.readings),
    }
