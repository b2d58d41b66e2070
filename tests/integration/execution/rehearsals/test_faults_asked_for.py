"""Faults are asked for in rehearsals, checked at the door, and can be asked for nowhere else."""

from __future__ import annotations

import pytest

from editor import services as editor
from execution.models import Rehearsal, Run
from execution.program_tests.site_digests import digests_of, what_changed
from registry.models import Device
from tests.kit.programs import SITE, TASK
from tests.kit.sign_in import join_and_sign_in, post_json
from vipo_device.descriptions.forms import CONTENT_TYPES

pytestmark = pytest.mark.django_db(transaction=True)
DEAD = {"version": 1, "faults": [{"fault": "dead", "device": "robot01", "at_s": 5.0}]}


@pytest.fixture
def program(factory):
    return editor.create_program(site=SITE, name="Task", document=TASK).id


def test_faults_reach_the_rehearsal_that_they_were_asked_for(program):
    client = join_and_sign_in("operator", SITE)
    assert post_json(client, f"/api/programs/{program}/rehearsals", {"faults": DEAD}).status_code == 202
    assert post_json(client, f"/api/programs/{program}/rehearsals", {}).status_code == 202
    jobs = Rehearsal.objects.order_by("created_at").values_list("job", flat=True)
    assert [job["scene"]["faults"] for job in jobs] == [DEAD, {"version": 1, "faults": []}]


def test_devices_that_know_no_command_by_its_id_are_named_in_rehearsals_and_tests(program):
    Device.objects.filter(pk="paintMixer02").update(source_type=CONTENT_TYPES["paper"])
    client = join_and_sign_in("operator", SITE)
    assert post_json(client, f"/api/programs/{program}/rehearsals", {}).status_code == 202
    author = join_and_sign_in("author", SITE)
    text = "name: It ends\nthen:\n  - ends: well\n"
    assert post_json(author, f"/api/programs/{program}/tests", {"text": text}).status_code == 201
    assert post_json(author, f"/api/programs/{program}/test-runs", {}).status_code == 202
    jobs = Rehearsal.objects.values_list("job", flat=True)
    assert [job["scene"]["idless"] for job in jobs] == [["paintMixer02"]] * 2
    with_it = digests_of(SITE)
    Device.objects.filter(pk="paintMixer02").update(stand_in=True)
    assert what_changed(with_it, digests_of(SITE)) is None, "a test is carried out with the real one's ways"
    Device.objects.filter(pk="paintMixer02").update(stand_in=False)
    Device.objects.filter(pk="paintMixer02").update(source_type=CONTENT_TYPES["turtle"])
    assert what_changed(with_it, digests_of(SITE)) == {"what": "devices", "devices": ["paintMixer02"]}


def test_how_a_rehearsal_was_asked_for_is_told_with_it(program):
    client = join_and_sign_in("operator", SITE)
    asked = {"seed": 7, "driver": "kinematic", "faults": DEAD}
    made = post_json(client, f"/api/programs/{program}/rehearsals", asked).json()
    told = {"version": 1, "seed": 7, "driver": "kinematic", "parameters": {}, "faults": DEAD["faults"], "paces": {}}
    assert (made["asked"], client.get(f"/api/rehearsals/{made['id']}").json()["asked"]) == (told, told)
    Rehearsal.objects.update(asked={})  # as those that were made before it was kept
    assert client.get(f"/api/rehearsals/{made['id']}").json()["asked"] is None


def test_a_refusal_says_which_fault_it_is_about(program):
    faults = [*DEAD["faults"], {"fault": "dead", "device": "nobody"}]
    refused = post_json(
        join_and_sign_in("operator", SITE),
        f"/api/programs/{program}/rehearsals",
        {"faults": {"version": 1, "faults": faults}},
    )
    assert (refused.status_code, refused.json()["args"]) == (422, {"number": 2})


@pytest.mark.parametrize(
    ("fault", "why"),
    [
        ({"fault": "dead", "device": "nobody"}, "Fault 1: there is no device 'nobody' here."),
        ({"fault": "explodes", "device": "robot01"}, "Fault 1: “fault” is one of fails,"),
        ({"fault": "dead", "device": "robot01", "at_step": "gone"}, "Fault 1: the program has no step 'gone'."),
    ],
)
def test_faults_that_make_no_sense_are_refused_with_a_sentence(program, fault, why):
    asked = {"faults": {"version": 1, "faults": [fault]}}
    refused = post_json(join_and_sign_in("operator", SITE), f"/api/programs/{program}/rehearsals", asked)
    assert (refused.status_code, refused.json()["code"]) == (422, "bad_faults")
    assert why in refused.json()["detail"]
    assert Rehearsal.objects.count() == 0


def test_who_may_not_rehearse_may_not_ask_for_faults(program):
    refused = post_json(join_and_sign_in("viewer", SITE), f"/api/programs/{program}/rehearsals", {"faults": DEAD})
    assert (refused.status_code, Rehearsal.objects.count()) == (403, 0)


def test_a_run_of_real_devices_takes_no_faults(program):
    refused = post_json(join_and_sign_in("operator", SITE), f"/api/programs/{program}/runs", {"faults": DEAD})
    assert (refused.status_code, Run.objects.count()) == (422, 0)
