"""Tests are carried out by the workers of rehearsals; what came of them is kept with what they were carried out on."""

from __future__ import annotations

from datetime import UTC, datetime

import pytest

from editor import services as editor
from execution import services, tasks
from execution.models import Rehearsal, TrialResult, TrialRun
from execution.program_tests.test_runs import queue_named_versions
from execution.rehearsals import test_results, worker
from execution.ticker import ticker
from tests.integration.execution.program_tests.conftest import FAILS, PASSES, UNUSABLE, add, put, waiting_program
from tests.kit.programs import SITE
from tests.kit.sign_in import join_and_sign_in, post_json

pytestmark = pytest.mark.django_db(transaction=True)


@pytest.fixture
def client(program):
    return join_and_sign_in("author", SITE)


def overview(client, program):
    return client.get(f"/api/programs/{program}/tests").json()


def run(client, program, **asked):
    started = post_json(client, f"/api/programs/{program}/test-runs", asked)
    assert started.status_code == 202, started.content
    return started.json()


def test_each_test_tells_what_it_expected_and_saw(client, program):
    for text in (PASSES, FAILS, UNUSABLE):
        add(client, program, text)
    started = run(client, program)
    assert (started["status"], started["total"], started["number"], started["mine"]) == ("queued", 3, None, True)
    assert [each["id"] for each in overview(client, program)["under_way"]] == [started["id"]]
    [waiting] = client.get(f"/api/sites/{SITE}/rehearsals").json()
    assert (waiting["id"], waiting["kind"], waiting["place"]) == (started["rehearsal"], "tests", 1)
    assert worker.carry_out_waiting() == 1
    shown = overview(client, program)
    assert (shown["under_way"], shown["last"]["status"]) == ([], "done")
    assert (shown["last"]["passed"], shown["last"]["total"]) == (1, 3)
    passed, failed, unusable = (test["result"] for test in shown["tests"])
    assert (passed["status"], passed["stale"], passed["seed"], passed["duration_s"]) == ("passed", None, 0, 5.0)
    assert [each["expected"] for each in passed["expectations"]] == ["ends well", "step 1 is carried out 1 times"]
    assert (failed["status"], failed["seed"]) == ("failed", 7)
    [quick] = failed["expectations"]
    assert (quick["expected"], quick["ok"], quick["line"]) == ("ends within 1 s", False, 4)
    assert quick["saw"].startswith("it took ")
    assert (unusable["status"], unusable["line"]) == ("unusable", 3)
    assert unusable["why"].startswith("The program has no step “9”. There are: ")
    assert Rehearsal.objects.get().result is None


def test_what_was_never_taken_is_told_of_all_tests_together(client, program):
    add(client, program, PASSES)
    assert overview(client, program)["coverage"] is None
    run(client, program)
    worker.carry_out_waiting()
    coverage = overview(client, program)["coverage"]
    assert (coverage["stale"], coverage["tests"]) == (False, 1)
    ways = {each["step"]: each["ways"] for each in coverage["constructs"]}
    assert ways == {"choice": {"reached": 1, "true": 1, "false": 0}, "pause": {"reached": 1}}


def test_a_result_is_stale_once_the_program_or_the_test_has_changed(client, program):
    made = add(client, program, PASSES)
    run(client, program)
    worker.carry_out_waiting()
    put(client, f"/api/programs/{program}/tests/{made['id']}", PASSES + "# more\n", '"1"')
    assert overview(client, program)["tests"][0]["result"]["stale"] == "test"
    document = client.get(f"/api/programs/{program}/document")
    changed = document.json()
    changed["steps"]["pause"]["params"]["duration"] = 6
    written = client.put(
        f"/api/programs/{program}/document", changed, content_type="application/json",
        headers={"If-Match": document["ETag"]},
    )  # fmt: skip
    assert written.status_code == 204, written.content
    shown = overview(client, program)
    assert shown["tests"][0]["result"]["stale"] == "program"
    assert shown["coverage"]["stale"] is True
    run(client, program)
    worker.carry_out_waiting()
    again = overview(client, program)
    assert (again["tests"][0]["result"]["stale"], again["tests"][0]["result"]["duration_s"]) == (None, 6.0)


def test_one_test_can_be_carried_out_alone_on_a_version(client, program):
    first, _ = add(client, program, PASSES), add(client, program, FAILS)
    editor.pin_version(program_id=program, user=None, message="As it was")
    run(client, program, tests=[first["id"]], version=1)
    worker.carry_out_waiting()
    done, other = overview(client, program)["tests"]
    assert (done["result"]["number"], done["result"]["stale"], other["result"]) == (1, None, None)
    assert client.get(f"/api/programs/{program}/version-tests").json() == []  # not all of them


def test_a_version_with_a_name_has_its_tests_carried_out_by_itself(client, program):
    add(client, program, PASSES), add(client, program, FAILS)
    pinned = post_json(client, f"/api/programs/{program}/versions", {"name": "For the trade fair"})
    assert pinned.status_code == 201
    tasks.rehearse("")
    [told] = client.get(f"/api/programs/{program}/version-tests").json()
    assert (told["number"], told["status"], told["passed"], told["total"]) == (1, "done", 1, 2)
    kept = TrialRun.objects.get()
    assert (kept.by_itself, kept.started_by, kept.number) == (True, "Author Person", 1)
    tasks.rehearse("")
    assert TrialRun.objects.count() == 1


def test_a_version_without_a_name_or_without_tests_asks_for_nothing(client, program):
    post_json(client, f"/api/programs/{program}/versions", {"name": "Before there were tests"})
    assert queue_named_versions() == 1
    add(client, program, PASSES)
    post_json(client, f"/api/programs/{program}/runs")
    assert queue_named_versions() == 0
    assert TrialRun.objects.count() == 0


def test_a_version_waits_for_its_tests_while_there_is_no_room(client, program, settings):
    settings.VIPO_REHEARSALS_OF_PERSON = 1
    add(client, program, PASSES)
    started = run(client, program)
    refused = post_json(client, f"/api/programs/{program}/test-runs")
    assert (refused.status_code, refused.json()["code"]) == (429, "too_many_rehearsals")
    post_json(client, f"/api/programs/{program}/versions", {"name": "Now"})
    assert (queue_named_versions(), TrialRun.objects.count()) == (0, 1)
    cancelled = post_json(client, f"/api/rehearsals/{started['rehearsal']}/cancel")
    assert cancelled.json()["status"] == "cancelled"
    assert overview(client, program)["last"]["status"] == "cancelled"
    assert (queue_named_versions(), TrialRun.objects.count()) == (1, 2)


def test_the_ticker_finds_versions_whose_tests_are_due(client, program, monkeypatch):
    sent = []
    monkeypatch.setattr(ticker.mailbox, "send_hint", lambda task, name: sent.append(task))
    add(client, program, PASSES)
    ticker.sweep(datetime.now(UTC))
    assert ticker.mailbox.REHEARSE not in sent
    post_json(client, f"/api/programs/{program}/versions", {"name": "Now"})
    ticker.sweep(datetime.now(UTC))
    assert ticker.mailbox.REHEARSE in sent


def test_a_program_with_errors_is_not_tested(client, factory):
    broken = editor.create_program(site=SITE, name="Broken", document=broken_program()).id
    add(client, broken, PASSES)
    refused = post_json(client, f"/api/programs/{broken}/test-runs")
    assert (refused.status_code, refused.json()["code"]) == (422, "not_ready")
    post_json(client, f"/api/programs/{broken}/versions", {"name": "Broken"})
    queue_named_versions()
    [told] = client.get(f"/api/programs/{broken}/version-tests").json()
    assert (told["status"], told["passed"], told["total"]) == ("failed", 0, 1)
    assert overview(client, broken)["last"]["reason"].startswith("The program has one error")


def broken_program():
    whole = waiting_program()
    whole["steps"]["pause"]["params"] = {}
    return whole


def test_without_tests_there_is_nothing_to_carry_out(client, program):
    refused = post_json(client, f"/api/programs/{program}/test-runs")
    assert (refused.status_code, Rehearsal.objects.count()) == (404, 0)
    assert refused.json()["detail"] == "The program has no tests yet. Write one first."


def test_when_the_time_for_all_is_over_the_rest_is_stopped(client, program, settings):
    settings.VIPO_REHEARSAL_LIMIT_S = 0
    add(client, program, PASSES), add(client, program, FAILS)
    run(client, program)
    worker.carry_out_waiting()
    assert [test["result"]["status"] for test in overview(client, program)["tests"]] == ["stopped", "stopped"]


def test_a_first_test_is_made_of_the_last_rehearsal(client, program):
    post_json(client, f"/api/programs/{program}/rehearsals", {"driver": "kinematic", "seed": 3})
    worker.carry_out_waiting()
    first = client.get(f"/api/programs/{program}/tests/first?of=rehearsal").json()
    assert first == {
        "text": "name: As rehearsed\nwhen:\n  seed: 3\nthen:\n- ends: well\n- within_s: 10\n", "of_rehearsal": True,
    }  # fmt: skip
    add(client, program, first["text"])
    run(client, program)
    worker.carry_out_waiting()
    assert overview(client, program)["last"]["passed"] == 1


def test_old_results_are_forgotten_and_deleted_tests_have_none(client, program, monkeypatch):
    monkeypatch.setattr(test_results, "KEPT_OF_TEST", 1)
    monkeypatch.setattr(test_results, "KEPT_OF_PROGRAM", 2)
    made = add(client, program, PASSES)
    found = {"test": made["id"], "revision": 1, "status": "passed", "seed": 0, "duration_s": 5.0, "taken": []}
    found["detail"] = {"expectations": [], "errors": [], "line": 0, "why": ""}
    for _ in range(3):
        started = run(client, program)
        test_results.keep_results(rehearsal=started["rehearsal"], found={"tests": [found], "ways": []})
        Rehearsal.objects.update(status="done")
    assert (TrialResult.objects.count(), TrialRun.objects.count()) == (1, 2)
    started = run(client, program)
    client.delete(f"/api/programs/{program}/tests/{made['id']}", headers={"If-Match": '"1"'})
    test_results.keep_results(rehearsal=started["rehearsal"], found={"tests": [found], "ways": []})
    assert (TrialResult.objects.count(), overview(client, program)["last"]["total"]) == (0, 0)


def test_tests_in_the_queue_are_no_rehearsal_to_look_at(client, program):
    add(client, program, PASSES)
    started = run(client, program)
    shown = services.get_rehearsal(rehearsal_id=started["rehearsal"])
    assert (shown.kind, shown.result, shown.document) == ("tests", None, {})
    assert client.get(f"/api/rehearsals/{started['rehearsal']}").json()["kind"] == "tests"
