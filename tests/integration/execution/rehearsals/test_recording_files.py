"""A rehearsal as a file: JSON as it is documented, and MCAP as the format's own reader reads it."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from io import BytesIO
from itertools import pairwise
from math import atan2
from typing import Any
from uuid import uuid4

import pytest
from mcap.reader import make_reader

from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import Drop, End, Instruction, Move, Pick, Plan, RoleBinding
from execution.models import Rehearsal
from execution.rehearsals import recording_file
from execution.rehearsals.rehearsal import Conditions, rehearse
from execution.rehearsals.views import view_rehearsal
from registry.models import Site
from simulation.world import Fault
from tests.kit import demo_floor
from tests.kit.programs import SITE
from tests.kit.sign_in import join_and_sign_in

pytestmark = pytest.mark.django_db(transaction=True)
SHELF, MIXER = PlaceRef(device="paintInventory01"), PlaceRef(device="paintMixer02")
CAN, ONE = Constant("can"), Constant(1)
CARRY = Plan(
    (
        Instruction(Move("robot", SHELF), "s1", 1),
        Instruction(Pick("robot", SHELF, CAN, ONE), "s1", 2),
        Instruction(Drop("robot", MIXER, CAN, ONE), "s1", 3),
        Instruction(End()),
    ),
    {"robot": RoleBinding("robot", None, ("move", "pick", "drop"))},
)
ASKED = {"version": 3, "seed": 0, "driver": "kinematic", "parameters": {}, "faults": []}


@pytest.fixture(scope="module")
def result() -> dict[str, Any]:
    """What a can's way leaves behind, with a robot that stands still on purpose for a while."""
    scene = demo_floor.scene(faults=(Fault("robot01", "stop", at_s=5.0, for_s=4.0),))
    return rehearse(CARRY, scene, places=demo_floor.places(), conditions=Conditions("kinematic"))


@pytest.fixture
def rehearsal(factory, result) -> Rehearsal:
    return Rehearsal.objects.create(
        site=Site.objects.get(slug=SITE), program=uuid4(), program_name="Can", status="done", result=result,
        asked=ASKED, document={"steps": {}}, compiled={"numbers": {"s1": "1"}}, created_at=datetime.now(UTC),
    )  # fmt: skip


def fetch(rehearsal: Rehearsal, form: str, role: str = "viewer") -> Any:
    return join_and_sign_in(role, SITE).get(f"/api/rehearsals/{rehearsal.pk}/recording?form={form}")


def test_json_has_a_format_a_version_and_all_that_is_known(rehearsal, result):
    answer = fetch(rehearsal, "json")
    assert answer["Content-Disposition"] == f'attachment; filename="rehearsal-{rehearsal.pk}.json"'
    told = answer.json()
    assert (told["format"], told["version"], told["site"]) == ("vipo-rehearsal", 1, SITE)
    assert (told["id"], told["program_name"], told["asked"]) == (str(rehearsal.pk), "Can", ASKED)
    assert (told["result"], told["document"]) == (result, {"steps": {}})
    assert not {"mine", "place", "progress", "course"} & told.keys()


def test_mcap_is_read_back_by_the_formats_own_reader(rehearsal, result):
    answer = fetch(rehearsal, "mcap")
    assert answer["Content-Disposition"] == f'attachment; filename="rehearsal-{rehearsal.pk}.mcap"'
    reader = make_reader(BytesIO(answer.content), validate_crcs=True)
    messages = [
        (channel.topic, schema.name, message.log_time / 1e9, json.loads(message.data))
        for schema, channel, message in reader.iter_messages()
    ]
    frames = result["frames"]
    poses = [each for each in messages if each[0] == "/robots/robot01/pose"]
    assert {name for _, name, _, _ in poses} == {"foxglove.PoseInFrame"}
    assert len(poses) == len(frames["robots"]["robot01"])
    for at, (_, _, t_s, said) in enumerate(poses):
        x, y, theta = frames["robots"]["robot01"][at]
        turned = said["pose"]["orientation"]
        assert t_s == pytest.approx(at * frames["dt_s"])
        assert (said["pose"]["position"]["x"], said["pose"]["position"]["y"]) == (x, y)
        assert 2 * atan2(turned["z"], turned["w"]) == pytest.approx(theta, abs=1e-4)
    loads = [said["objects"] for topic, _, _, said in messages if topic == "/robots/robot01/carrying"]
    assert loads == [{}, {"can": 1}, {}]
    steps = [(said["number"], said["status"], said["robot"]) for topic, _, _, said in messages if topic == "/steps"]
    assert steps == [("1", "running", "robot01"), ("1", "done", "robot01")]
    log = [said["message"] for topic, name, _, said in messages if topic == "/log" and name == "foxglove.Log"]
    assert log == [line["text"] for line in result["log"]]
    assert all(before <= after for (_, _, before, _), (_, _, after, _) in pairwise(messages))
    [facts] = list(reader.iter_metadata())
    assert (facts.name, facts.metadata["program_name"], facts.metadata["ok"]) == ("vipo-rehearsal", "Can", "true")
    assert json.loads(facts.metadata["asked"]) == ASKED
    summary = reader.get_summary()
    assert summary is not None
    assert {schema.encoding for schema in summary.schemas.values()} == {"jsonschema"}


def test_very_many_poses_are_thinned_evenly(rehearsal, result, monkeypatch):
    monkeypatch.setattr(recording_file, "MOST_POSES", 100)
    content = recording_file.write_mcap(view_rehearsal(rehearsal))
    times = [
        message.log_time
        for _, channel, message in make_reader(BytesIO(content)).iter_messages()
        if channel.topic == "/robots/robot01/pose"
    ]
    recorded = len(result["frames"]["robots"]["robot01"])
    assert len(times) * len(result["frames"]["robots"]) <= 100 + len(result["frames"]["robots"])
    assert recorded > 3 * len(times)
    assert len({after - before for before, after in pairwise(times)}) == 1


def test_tests_of_a_program_are_said_to_have_no_recording(rehearsal):
    Rehearsal.objects.update(kind="tests", result=None)
    answer = fetch(rehearsal, "mcap")
    assert (answer.status_code, answer.json()["detail"]) == (
        409,
        "Tests of a program have no recording. Rehearse the program; a rehearsal has one.",
    )


def test_what_has_no_recording_is_refused_with_a_sentence(rehearsal):
    Rehearsal.objects.update(status="running", result=None)
    refused = fetch(rehearsal, "mcap")
    assert (refused.status_code, refused.json()["code"]) == (409, "not_possible_now")
    assert "it is running" in refused.json()["detail"]
    assert fetch(rehearsal, "mp4", "operator").status_code == 422


def test_a_stranger_does_not_learn_that_it_exists(rehearsal):
    client = join_and_sign_in("stranger", SITE)
    answers = [client.get(f"/api/rehearsals/{each}/recording?form=json") for each in (rehearsal.pk, uuid4())]
    assert [(answer.status_code, answer.json()["detail"]) for answer in answers] == [
        (404, "There is no such rehearsal. It may have been deleted with its program.")
    ] * 2
