"""The tests of a program on a version of a library function that it is offered, before it is taken in."""

from __future__ import annotations

from typing import Any
from uuid import UUID, uuid4

import pytest

from editor import services as editor
from execution.models import TrialResult, TrialRun
from execution.rehearsals import test_results, worker
from registry import services as registry
from tests.integration.execution.program_tests.conftest import add
from tests.kit.programs import SITE, document, step
from tests.kit.sign_in import add_person, find_person, join_and_sign_in, post_json, signed_in

pytestmark = pytest.mark.django_db(transaction=True)
F = ("f", "body")
ENDS = "name: It ends\nthen:\n  - ends: well\n"
QUICK = "name: It takes no longer\nthen:\n  - within_s: 7\n"


def pausing(seconds: int, **more: Any) -> dict[str, Any]:
    """Return a program with a function that waits for so long."""
    steps = {"pause": step("wait", F, duration=seconds)}
    return document(steps, functions={"f": {"name": "pause", "parameters": []}}, **more)


def save(content: dict[str, Any], site: str = SITE, who: str = "author") -> dict[str, Any]:
    program = str(editor.create_program(site=site, name="Source", document=content).id)
    body = {"program": program, "function": "f", "name": "Pause", "visibility": "site"}
    saved = post_json(signed_in(who), f"/api/sites/{site}/library", body)
    assert saved.status_code == 201, saved.content
    return dict(saved.json())


@pytest.fixture
def client(factory):
    return join_and_sign_in("author", SITE)


@pytest.fixture
def library(client) -> str:
    """A function that waits for five seconds, and for nine in its second version."""
    first = save(pausing(5))
    second = save(pausing(9))
    assert (first["id"], second["version"]) == (second["id"], 2)
    return str(first["id"])


@pytest.fixture
def program(library) -> str:
    """A program that holds the first version, and calls it."""
    functions = {"mine": {"name": "pause", "parameters": [], "source": {"library": library, "version": 1}}}
    steps = {"inner": step("wait", ("mine", "body"), duration=5), "call": step("call", function="mine", args={})}
    return str(editor.create_program(site=SITE, name="Holds it", document=document(steps, functions=functions)).id)


def run(client, program, **asked):
    return post_json(client, f"/api/programs/{program}/test-runs", asked)


def test_an_update_is_tried_without_changing_the_program_or_what_its_tests_tell(client, program, library) -> None:
    for text in (ENDS, QUICK):
        add(client, program, text)
    before = editor.get_document(program_id=program)
    run(client, program)
    worker.carry_out_waiting()
    told = client.get(f"/api/programs/{program}/tests").json()
    assert [each["result"]["status"] for each in told["tests"]] == ["passed", "passed"]

    started = run(client, program, update={"library": library, "version": 2})
    assert started.status_code == 202, started.content
    path = f"/api/programs/{program}/test-runs/{started.json()['id']}"
    waiting = client.get(path).json()
    assert (waiting["status"], waiting["results"], waiting["update"]) == (
        "queued",
        [],
        {"library": library, "version": 2},
    )
    worker.carry_out_waiting()
    over = client.get(path).json()
    assert (over["status"], over["passed"], over["total"]) == ("done", 1, 2)
    ends, quick = over["results"]
    assert (ends["name"], ends["status"], ends["duration_s"]) == ("It ends", "passed", 9.0)
    assert (quick["status"], quick["expectations"][0]["ok"]) == ("failed", False)
    assert quick["expectations"][0]["saw"].startswith("it took 9")

    assert editor.get_document(program_id=program) == before
    after = client.get(f"/api/programs/{program}/tests").json()
    assert [each["result"] for each in after["tests"]] == [each["result"] for each in told["tests"]]
    assert (after["last"]["id"], after["under_way"]) == (told["last"]["id"], [])
    assert after["coverage"] == told["coverage"]


def test_an_update_that_the_program_does_not_fit_is_told(client, program, library) -> None:
    add(client, program, ENDS)
    wants = document(
        {"pause": step("wait", F, duration=5)},
        functions={"f": {"name": "pause", "parameters": [{"name": "minutes", "type": "number", "unit": "MIN"}]}},
    )
    assert save(wants)["version"] == 3
    refused = run(client, program, update={"library": library, "version": 3})
    assert refused.status_code == 422, refused.content
    assert refused.json()["args"]["first"]["en"] == "Enter minutes for pause."


@pytest.mark.parametrize("asked", [{"version": 1}, {"changes": True}])
def test_an_update_is_tried_on_what_is_drawn_alone(client, program, library, asked) -> None:
    add(client, program, ENDS)
    editor.pin_version(program_id=program, user=None, message="")
    refused = run(client, program, update={"library": library, "version": 2}, **asked)
    assert refused.status_code == 422
    assert not TrialRun.objects.exists()


def test_what_is_not_held_not_there_or_not_seen_is_refused(client, program, library) -> None:
    add(client, program, ENDS)
    other = editor.create_program(site=SITE, name="Without it", document=document({})).id
    add(client, other, ENDS)
    assert run(client, other, update={"library": library, "version": 2}).status_code == 422
    for update in ({"library": library, "version": 7}, {"library": str(uuid4()), "version": 1}):
        assert run(client, program, update=update).status_code == 404
    for update in ({"library": library, "version": 0}, {"library": library}, {"library": "x", "version": 1}):
        assert run(client, program, update=update).status_code == 422

    registry.create_site(name="Shed", slug="shed")
    add_person("elsewhere")
    registry.set_member(site="shed", email="elsewhere@vipo.example", role="author")
    hidden = save(pausing(1), "shed", "elsewhere")["id"]
    functions = {"mine": {"name": "pause", "parameters": [], "source": {"library": hidden, "version": 1}}}
    holder = editor.create_program(site=SITE, name="Holds another's", document=document({}, functions=functions)).id
    add(client, holder, ENDS)
    assert run(client, holder, update={"library": hidden, "version": 1}).status_code == 404
    assert not TrialRun.objects.exists()


def test_a_run_of_tests_is_read_by_members_alone(client, program, library) -> None:
    add(client, program, ENDS)
    started = run(client, program, update={"library": library, "version": 2}).json()["id"]
    registry.create_site(name="Shed", slug="shed")
    add_person("elsewhere")
    path = f"/api/programs/{program}/test-runs"
    assert join_and_sign_in("viewer", SITE).get(f"{path}/{started}").status_code == 200
    assert signed_in("elsewhere").get(f"{path}/{started}").status_code == 404
    assert client.get(f"{path}/{uuid4()}").status_code == 404
    other = editor.create_program(site=SITE, name="Other", document=document({})).id
    assert client.get(f"/api/programs/{other}/test-runs/{started}").status_code == 404


def test_updates_that_were_tried_often_push_no_result_of_the_program_away(
    client, program, library, monkeypatch
) -> None:
    monkeypatch.setattr(test_results, "KEPT_OF_TEST", 2)
    add(client, program, ENDS)
    run(client, program)
    worker.carry_out_waiting()
    for _ in range(3):
        run(client, program, update={"library": library, "version": 2})
        worker.carry_out_waiting()
    assert TrialResult.objects.filter(run__update__isnull=False).count() == 2
    assert client.get(f"/api/programs/{program}/tests").json()["tests"][0]["result"]["status"] == "passed"


def test_a_helper_that_the_new_version_renamed_goes_with_the_version_that_is_held(client) -> None:
    def using(helper: str, **source: Any) -> dict[str, Any]:
        steps = {"go": step("call", F, function="h", args={}), "in": step("wait", ("h", "body"), duration=5)}
        functions = {"f": {"name": "pause", "parameters": [], **source}, "h": {"name": helper, "parameters": []}}
        return document(steps, functions=functions)

    library = save(using("rinse"))["id"]
    assert save(using("flush"))["version"] == 2
    drawn = using("rinse", source={"library": library, "version": 1})
    program = editor.create_program(site=SITE, name="Holds it", document=drawn).id
    updated = editor.get_updated_content(
        program_id=program, library=UUID(library), version=2, user=find_person("author")
    )
    assert sorted(each["name"] for each in updated.document["functions"].values()) == ["flush", "pause"]
