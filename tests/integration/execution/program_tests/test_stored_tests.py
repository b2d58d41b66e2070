"""Tests stand beside a program: written by authors alone, never over somebody else's words, and no more than bounds."""

from __future__ import annotations

from uuid import uuid4

import pytest

from editor import services as editor
from execution.models import ProgramTest, TrialRun
from execution.program_tests import stored_tests
from execution.trials.trial_file import read_trials
from tests.integration.execution.program_tests.conftest import FAILS, PASSES, add, put
from tests.kit.programs import SITE
from tests.kit.sign_in import EVERYBODY, from_role, join_and_sign_in, post_json, signed_in

pytestmark = pytest.mark.django_db(transaction=True)


def test_a_test_is_kept_listed_and_read_as_it_was_written(program):
    client = join_and_sign_in("author", SITE)
    made = add(client, program, PASSES)
    assert (made["name"], made["text"], made["tag"]) == ("It ends", PASSES, '"1"')
    [listed] = client.get(f"/api/programs/{program}/tests").json()["tests"]
    assert (listed["id"], listed["name"], listed["tag"], listed["result"]) == (made["id"], "It ends", '"1"', None)
    assert listed["edited_by"] == "Author Person"
    shown = client.get(f"/api/programs/{program}/tests/{made['id']}")
    assert (shown.json(), shown["ETag"]) == (made, '"1"')


def test_of_two_who_write_one_test_the_second_is_told(program):
    client = join_and_sign_in("author", SITE)
    path = f"/api/programs/{program}/tests/{add(client, program, PASSES)['id']}"
    first = put(client, path, PASSES.replace("It ends", "It ends well"), '"1"')
    assert (first.status_code, first["ETag"]) == (200, '"2"')
    second = put(client, path, FAILS, '"1"')
    assert (second.status_code, second.json()["code"]) == (412, "changed")
    assert client.delete(path, headers={"If-Match": '"1"'}).status_code == 412
    assert put(client, path, FAILS, "").status_code == 428
    assert ProgramTest.objects.get().name == "It ends well"
    assert client.delete(path, headers={"If-Match": '"2"'}).status_code == 204
    assert client.get(path).status_code == 404


@pytest.mark.parametrize(
    ("text", "line", "why"),
    [
        ("name: A\nthen:\n  - ends: badly\n", 3, "Write “ends: well”"),
        ("name: A\nwhen: {sed: 1}\nthen:\n  - ends: well\n", 2, "“sed” is not known here."),
        ("name: A\nthen: [", 2, "It is no YAML"),
        ("a: &x 1\nb: *x\n", 1, "anchor"),
        ("- 1\n", 1, "Here stand words"),
        ('name: "A\\uD800"\nthen:\n  - ends: well\n', 1, "It is no YAML: U+D800"),
        ('name: "A\\0"\nthen:\n  - ends: well\n', 1, "It is no YAML: U+0000"),
        ("", 1, "Here stand words"),
        ("name: A\nthen:\n  - ends: well\n" + "#" * 20_000, 0, "at most 20000 characters"),
    ],
)
def test_what_is_no_test_is_refused_with_its_line_and_kept_nowhere(program, text, line, why):
    client = join_and_sign_in("author", SITE)
    refused = post_json(client, f"/api/programs/{program}/tests", {"text": text})
    assert refused.status_code == 422
    if len(text) <= stored_tests.MOST_TEXT:
        assert (refused.json()["code"], refused.json()["args"]["line"]) == ("bad_test", line)
        assert why in refused.json()["detail"]
        looked = post_json(client, f"/api/programs/{program}/tests/look", {"text": text}).json()["fault"]
        assert looked["line"] == line
        assert why in looked["why"]
    assert ProgramTest.objects.count() == 0


def test_a_text_that_is_a_test_has_no_fault(program):
    client = join_and_sign_in("author", SITE)
    assert post_json(client, f"/api/programs/{program}/tests/look", {"text": PASSES}).json() == {"fault": None}
    assert ProgramTest.objects.count() == 0


def test_a_name_stands_once_and_there_is_an_end_to_tests(program, monkeypatch):
    client = join_and_sign_in("author", SITE)
    add(client, program, PASSES)
    other = add(client, program, FAILS)
    assert post_json(client, f"/api/programs/{program}/tests", {"text": PASSES}).json()["code"] == "test_name_taken"
    taken = put(client, f"/api/programs/{program}/tests/{other['id']}", PASSES, '"1"')
    assert (taken.status_code, taken.json()["code"]) == (409, "test_name_taken")
    monkeypatch.setattr(stored_tests, "MOST_TESTS", 2)
    full = post_json(client, f"/api/programs/{program}/tests", {"text": PASSES.replace("It", "That")})
    assert (full.status_code, full.json()["code"]) == (409, "tests_full")
    assert ProgramTest.objects.count() == 2


def test_a_file_is_brought_in_whole_or_not_at_all_and_goes_out_as_vipo_test_reads_it(program):
    client = join_and_sign_in("author", SITE)
    path = f"/api/programs/{program}/tests"
    file = (
        "version: 1\nprogram: ../a.json\ntests:\n"
        "  # The good day.\n  - name: It ends\n    then:\n      - ends: well  # as ever\n\n"
        "  - {name: 'In: one line', then: [{within_s: 9}]}\n"
    )
    brought = post_json(client, f"{path}/import", {"text": file})
    assert brought.status_code == 201
    assert [made["text"] for made in brought.json()] == [
        "name: It ends\nthen:\n  - ends: well  # as ever\n",
        "{name: 'In: one line', then: [{within_s: 9}]}\n",
    ]
    sent = client.get(f"{path}/file")
    assert (sent["Content-Type"], sent["Content-Disposition"]) == (
        "application/yaml", 'attachment; filename="wait-a-bit.yaml"',
    )  # fmt: skip
    read = read_trials(sent.content)
    assert (read.program, [trial.name for trial in read.trials]) == ("wait-a-bit.json", ["It ends", "In: one line"])
    again = post_json(client, f"{path}/import", {"text": file.replace("'In: one line'", "New")})
    assert (again.status_code, again.json()["args"]) == (409, {"name": "It ends"})
    bad = post_json(client, f"{path}/import", {"text": file.replace("within_s", "within")})
    known = "commands, ends, fails, item, never_two_in, property, step, within_s"
    assert (bad.json()["code"], bad.json()["args"]) == ("bad_test", {"why": "one_of", "known": known, "line": 9})
    assert ProgramTest.objects.count() == 2


def test_a_first_test_is_a_test_and_its_name_is_free(program):
    client = join_and_sign_in("author", SITE)
    path = f"/api/programs/{program}/tests"
    first = client.get(f"{path}/first").json()
    assert first == {"text": "name: All goes well\nthen:\n- ends: well\n", "of_rehearsal": False}
    add(client, program, first["text"])
    second = client.get(f"{path}/first?of=rehearsal").json()
    assert (second["of_rehearsal"], second["text"].splitlines()[0]) == (False, "name: All goes well 2")


@pytest.mark.parametrize("who", EVERYBODY)
def test_who_may_draw_writes_tests_and_who_may_look_reads_them(program, who):
    made = add(join_and_sign_in("author", SITE), program, PASSES)
    client = signed_in(who) if who in ("author", "nobody") else join_and_sign_in(who, SITE)
    path = f"/api/programs/{program}/tests"
    outside = {"stranger": 404, "nobody": 401}.get(who)
    writes = 200 if who in from_role("author") else 403
    assert client.get(path).status_code == (outside or 200)
    assert client.get(f"{path}/file").status_code == (outside or 200)
    assert client.get(f"{path}/{made['id']}").status_code == (outside or 200)
    assert client.get(f"/api/programs/{program}/version-tests").status_code == (outside or 200)
    assert client.get(f"{path}/first").status_code == (outside or writes)
    assert post_json(client, f"{path}/look", {"text": ""}).status_code == (outside or writes)
    assert put(client, f"{path}/{made['id']}", FAILS, '"1"').status_code == (outside or writes)
    assert post_json(client, path, {"text": PASSES}).status_code == (outside or (201 if writes == 200 else 403))
    runs = 202 if who in from_role("operator") else 403
    assert post_json(client, f"/api/programs/{program}/test-runs").status_code == (outside or runs)
    assert ProgramTest.objects.count() == (2 if writes == 200 and outside is None else 1)
    assert TrialRun.objects.count() == (1 if runs == 202 and outside is None else 0)
    deleted = client.delete(f"{path}/{made['id']}", headers={"If-Match": '"2"'})
    assert deleted.status_code == (outside or (204 if writes == 200 else 403))


def test_a_test_of_another_program_is_not_there(program):
    client = join_and_sign_in("author", SITE)
    other = editor.create_program(site=SITE, name="Other").id
    made = add(client, program, PASSES)
    assert client.get(f"/api/programs/{other}/tests/{made['id']}").status_code == 404
    assert put(client, f"/api/programs/{other}/tests/{made['id']}", FAILS, '"1"').status_code == 404
    assert post_json(client, f"/api/programs/{other}/test-runs", {"tests": [made["id"]]}).status_code == 404
    assert client.get(f"/api/programs/{uuid4()}/tests").status_code == 404
    editor.delete_program(program_id=program)
    assert ProgramTest.objects.count() == 0
