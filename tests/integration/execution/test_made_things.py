"""Whatever a call makes has an address, which the call tells in `Location`: 201, or 202 where work goes on."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.test import Client

from editor import services as editor
from execution.models import Run
from registry import services as registry
from registry.floorplan.map_server import write_pgm, write_yaml
from tests.kit import demo_floor
from tests.kit.api_rights import OPERATIONS
from tests.kit.programs import SITE, TASK, document
from tests.kit.sign_in import PASSWORD, find_person, join_and_sign_in, post_json
from tests.unit.robot_agent.agent import RobotGrid, write_grid
from vipo_site.http.location_header import MADE

pytestmark = pytest.mark.django_db(transaction=True)
AT_SITE = f"/api/sites/{SITE}"
YAML = b"image: a.pgm\nresolution: 1.0\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n"
LATER = {"start_run", "start_rehearsal", "run_tests", "call_method"}
FILE_OF_TESTS = "version: 1\nprogram: a.json\ntests:\n- {name: It ends, then: [ends: well]}\n"


@pytest.fixture
def admin(factory: Any) -> Client:
    client = join_and_sign_in("admin", SITE)
    registry.set_site_quota(email=find_person("admin").email, sites=3)
    grid = demo_floor.grid()
    said = RobotGrid(grid.width, grid.height, grid.resolution_m, (grid.origin_x_m, grid.origin_y_m, 0.0), grid.cells)
    for message in write_grid(said, 1, 1):
        registry.ingest_map_part(device_id="robot01", payload=message, at=datetime.now(UTC))
    return client


def make_each(client: Client) -> dict[str, Any]:
    """Return what each call answers that makes something, by its name."""
    drawn = document({}, functions={"f": {"name": "Greet", "parameters": []}})
    source = editor.create_program(site=SITE, name="Source", document=drawn).id
    task = editor.create_program(site=SITE, name="Task", document=TASK).id
    image = SimpleUploadedFile("a.pgm", b"P5 2 2 255 " + bytes([255] * 4))
    function = {"program": str(source), "function": "f", "name": "Greet"}
    invitation = post_json(client, f"{AT_SITE}/invitations", {"role": "viewer"})
    code = invitation.json()["link"].rpartition("#")[2]
    grid = demo_floor.grid()
    person = {"code": code, "name": "Nora Lind", "email": "nora@vipo.example", "password": "a-horse-in-the-rain-9"}
    threads = f"/api/programs/{task}/threads"
    thread = post_json(client, threads, {"text": "Why wait?", "anchor": {"kind": "program"}})
    saved = post_json(client, f"{AT_SITE}/library", function)
    registry.create_site(name="Shed", slug="shed")
    registry.set_member(site="shed", email=find_person("admin").email, role="author")
    answers = {
        "make_invitation": invitation,
        "make_wall_screen": post_json(client, f"{AT_SITE}/wall-screens", {"name": "Hall 1"}),
        "begin_second_factor": post_json(client, "/api/me/second-factor", {"password": PASSWORD}),
        "join_as_new": post_json(Client(), "/api/invitations/join", person),
        "upload_site": client.post(
            "/api/sites", {"name": "New", "yaml": SimpleUploadedFile("a.yaml", YAML), "image": image}
        ),
        "create_token": post_json(client, f"{AT_SITE}/tokens", {"name": "Mine", "scopes": ["read"]}),
        "reserve_device": post_json(client, f"{AT_SITE}/newcomers", {"id": "mixer-9"}),
        "use_robot_map": post_json(
            client, f"{AT_SITE}/map/from-device", {"device": "robot01", "version": 1, "replaces": 1}
        ),
        "restore_map": post_json(client, f"{AT_SITE}/map/restore", {"version": 1, "replaces": 2}),
        "upload_map": client.post(
            f"{AT_SITE}/map/upload",
            {
                "yaml": SimpleUploadedFile("m.yaml", write_yaml(grid, "m.pgm")),
                "image": SimpleUploadedFile("m.pgm", write_pgm(grid)),
            },
            headers={"If-Match": client.get(f"{AT_SITE}/map").json()["tag"]},
        ),
        "add_zone": post_json(
            client,
            f"{AT_SITE}/zones",
            {"name": "Aisle", "rule": "keep_out", "points": [[7.0, -8.0], [8.0, -8.0], [8.0, -7.0]]},
        ),
        "add_obstacle": post_json(client, f"{AT_SITE}/obstacles", {"x": 7.0, "y": -8.0}),
        "add_place": post_json(client, f"{AT_SITE}/places", {"name": "Bench", "kind": "point", "x": 7.0, "y": -8.0}),
        "create_program": post_json(client, f"{AT_SITE}/programs", {"name": "New"}),
        "pin_version": post_json(client, f"/api/programs/{task}/versions"),
        "copy_version": post_json(client, f"/api/programs/{task}/versions/1/copy", {"name": "Copy"}),
        "start_thread": thread,
        "answer_thread": post_json(client, f"{threads}/{thread.json()['id']}/comments", {"text": "For the paint."}),
        "add_test": post_json(
            client, f"/api/programs/{task}/tests", {"text": "name: It is quick\nthen:\n- within_s: 60\n"}
        ),
        "import_tests": post_json(client, f"/api/programs/{task}/tests/import", {"text": FILE_OF_TESTS}),
        "run_tests": post_json(client, f"/api/programs/{task}/test-runs"),
        "save_function": saved,
        "fork_function": post_json(
            client, f"{AT_SITE}/library/forks", {"function": saved.json()["id"], "name": "Greet again"}
        ),
        "start_rehearsal": post_json(client, f"/api/programs/{task}/rehearsals"),
        "call_method": post_json(
            client, f"{AT_SITE}/devices/paintMixer01/call", {"method": "mixPaint", "args": {"time": 5}}
        ),
        "promote_program": post_json(client, f"/api/programs/{task}/promotion", {"site": "shed", "name": "Moved"}),
    }
    run = answers["start_run"] = post_json(client, f"/api/programs/{task}/runs")
    Run.objects.filter(id=run.json()["id"]).update(started_at=datetime.now(UTC))
    words = {"text": "Why so?", "t_s": 0}
    answers["comment_on_run"] = post_json(client, f"/api/runs/{run.json()['id']}/threads", words)
    return answers


def test_each_call_that_makes_something_says_so_and_where_it_is(admin: Client) -> None:
    answers = make_each(admin)
    assert answers.keys() == MADE.keys()
    told = {name: (answer.status_code, "Location" in answer) for name, answer in answers.items()}
    assert told == {name: (202 if name in LATER else 201, True) for name in MADE}
    found = {name: admin.get(answer["Location"]) for name, answer in answers.items()}
    # A device whose id is reserved is there once it has described itself.
    assert {name: answer.status_code for name, answer in found.items()} == {
        name: 404 if name == "reserve_device" else 200 for name in MADE
    }
    for name in ("upload_site", "create_program", "pin_version", "save_function", "start_run", "start_rehearsal"):
        key = "slug" if name == "upload_site" else "id"
        assert found[name].json()[key] == answers[name].json()[key], name


def test_a_version_that_is_there_already_is_not_made_again(admin: Client) -> None:
    program = editor.create_program(site=SITE, name="Task", document=TASK).id
    made = [post_json(admin, f"/api/programs/{program}/versions") for _ in range(2)]
    assert [answer.status_code for answer in made] == [201, 200]
    assert made[0]["Location"] == made[1]["Location"] == f"/api/programs/{program}/versions/1"
    whole = admin.get(made[0]["Location"]).json()
    assert whole["document"]["steps"].keys() == TASK["steps"].keys()


def test_a_refused_call_names_no_place(admin: Client) -> None:
    answer = post_json(admin, f"{AT_SITE}/programs", {"name": ""})
    assert (answer.status_code, "Location" in answer) == (422, False)


def test_the_description_says_which_calls_make_something() -> None:
    making = {
        call["operationId"]: sorted({*call["responses"]} & {"201", "202"})
        for calls in OPERATIONS.values()
        for call in calls.values()
        if {*call["responses"]} & {"201", "202"}
    }
    assert making.keys() - MADE.keys() == {"invoke_action", "cancel_action"}
    for calls in OPERATIONS.values():
        for call in calls.values():
            for status in making.get(call["operationId"], ()):
                if call["operationId"] != "cancel_action":
                    assert "Location" in call["responses"][status]["headers"], call["operationId"]
