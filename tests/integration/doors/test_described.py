"""The API is what docs/openapi.json says: Schemathesis asks every operation what fits and what does not.

It asks a served VIPO on PostgreSQL, as an admin and as a viewer, the same questions each time. An answer is wrong if it
is a failure of ours, has a status or a content type that is not described, a header or a body that does not fit its
description, or if it takes what the description refuses.
"""

from __future__ import annotations

import copy
import json
import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from schemathesis import GenerationMode
from schemathesis.checks import not_a_server_error
from schemathesis.config import (
    ChecksConfig,
    GenerationConfig,
    NotAServerErrorConfig,
    ProjectConfig,
    ProjectsConfig,
    SchemathesisConfig,
)
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    negative_data_rejection,
    response_headers_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from tests.integration.doors.described_web import ROLES
from tests.kit.api_rights import OPERATIONS
from tests.kit.files import ROOT
from tests.kit.processes.forked import ForkedPython, run_forked
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis, answers, free_port, wait_ready

CHECKS = [
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_headers_conformance,
    response_schema_conformance,
    negative_data_rejection,
]
"""Not `positive_data_acceptance`: whether a device may do something now stands in no description."""
ENDLESS = {"watch_things", "watch_value"}
"""Not asked here, since their answers go on: test_event_stream.py and test_property_values.py read them."""
UNBOUNDED = {"interval"}
"""Parameters that are left out, since an answer with them goes on (MTConnect's streams; test_streams.py)."""
EXAMPLES = 2 if os.environ.get("VIPO_STEADY") == "1" else 4
"""Of what fits and of what does not, for each operation and role; fewer where a change is judged."""
NAMES = sorted(call["operationId"] for calls in OPERATIONS.values() for call in calls.values())
CSRF = "a" * 32
pytestmark = pytest.mark.servers


@dataclass(frozen=True, slots=True)
class Described:
    """The running site and its description."""

    url: str
    sessions: dict[str, str]
    operations: dict[str, Any]


@pytest.fixture(scope="module")
def described(
    tmp_path_factory: pytest.TempPathFactory, module_database_url: str, shared_redis: Redis
) -> Iterator[Described]:
    folder, port = tmp_path_factory.mktemp("described"), free_port()
    environment = served_without_broker(folder, module_database_url, shared_redis.url)
    environment["DJANGO_SETTINGS_MODULE"] = "tests.settings"
    command = [sys.executable, "-m", "tests.integration.doors.described_web"]
    made = run_forked([*command, "prepare", *NAMES], cwd=ROOT, env=environment, capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    prepared = json.loads(made.stdout)
    log = folder / "web.log"
    with log.open("ab") as out:
        process = ForkedPython([*command, str(port)], cwd=ROOT, env=environment, stdout=out, stderr=out)
    try:
        wait_ready(lambda: answers(port), log.read_text, process)
        yield Described(f"http://127.0.0.1:{port}", prepared["sessions"], read_description(prepared["known"]))
    finally:
        process.kill()
        process.wait()


def read_description(known: dict[str, str]) -> dict[str, Any]:
    """Return Schemathesis' operations by their names; what addresses name is there, so that calls get far."""
    text = with_plain_tuples(json.loads((ROOT / "docs" / "openapi.json").read_text()))
    for calls in text["paths"].values():
        for call in calls.values():
            # `default` stands for every status: with it none would be one that is not described.
            call["responses"].pop("default", None)
            call["parameters"] = [
                {**each, "schema": {**each["schema"], "enum": [typed(each["schema"], known[each["name"]])]}}
                if each["in"] == "path" and each["name"] in known
                else each
                for each in copy.deepcopy(call.get("parameters", []))
                if each["name"] not in UNBOUNDED
            ]
    generation = GenerationConfig(with_security_parameters=False, deterministic=True)
    checks = ChecksConfig(not_a_server_error=NotAServerErrorConfig(expected_statuses=["2xx", "3xx", "4xx", 501]))
    config = SchemathesisConfig(projects=ProjectsConfig(default=ProjectConfig(generation=generation, checks=checks)))
    schema = schemathesis.openapi.from_dict(text, config=config)
    return {result.ok().definition.raw["operationId"]: result.ok() for result in schema.get_all_operations()}


def with_plain_tuples(value: Any) -> Any:
    """Return a description in which `[x, y]` is a list of two alike: Schemathesis reads no `prefixItems` there."""
    if isinstance(value, list):
        return [with_plain_tuples(item) for item in value]
    if not isinstance(value, dict):
        return value
    plain = {name: with_plain_tuples(inner) for name, inner in value.items()}
    first, *others = plain.get("prefixItems", [None])
    if first is not None and all(item == first for item in others):
        return {**{name: inner for name, inner in plain.items() if name != "prefixItems"}, "items": first}
    return plain


def typed(schema: dict[str, Any], value: str) -> str | int:
    return int(value) if schema.get("type") == "integer" else value


def ask(described: Described, name: str, mode: GenerationMode) -> None:
    """Ask the same as each role."""
    cookies = [{"sessionid": described.sessions[f"{name} {role}"], "csrftoken": CSRF} for role in ROLES]

    @settings(
        derandomize=True,
        database=None,
        deadline=None,
        max_examples=EXAMPLES,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(case=described.operations[name].as_strategy(generation_mode=mode))
    def try_each(case: schemathesis.Case) -> None:
        for signed_in in cookies:
            case.call_and_validate(
                base_url=described.url, headers={"X-CSRFToken": CSRF}, cookies=signed_in, checks=CHECKS, timeout=30
            )

    try_each()


@pytest.mark.parametrize("name", [name for name in NAMES if name not in ENDLESS])
def test_an_operation_answers_as_it_is_described(described: Described, name: str) -> None:
    ask(described, name, GenerationMode.POSITIVE)
    operation = described.operations[name]
    if operation.path_parameters or operation.query or operation.body:
        ask(described, name, GenerationMode.NEGATIVE)
