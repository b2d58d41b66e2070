"""Every operation of the API asked once, and a site at which there is one of everything that addresses name."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from http.cookies import SimpleCookie
from typing import Any
from uuid import UUID, uuid4

from django.core.files.uploadedfile import SimpleUploadedFile
from django.db import transaction
from django.test import Client

from editor import services as editor
from editor.models import Comment, CommentThread
from execution.models import (
    Calibration,
    Command,
    DeadLetter,
    Measurement,
    ProgramTest,
    Question,
    Rehearsal,
    Run,
    TrialRun,
)
from registry import services
from registry.maps.obstacles import add_obstacle
from registry.models import Device, DeviceAlert, Site, User
from registry.people.wall_screens import make_wall_screen
from registry.sites.invitations import Wanted, make_invitation
from tests.kit.api_rights import OPERATIONS
from tests.kit.programs import document
from tests.kit.sites import NOW, ROBOT, describe
from tests.unit.robot_agent.agent import RobotGrid, write_grid
from vipo_device.protocol.description import MethodSpec, PropertySpec

ANSWER: dict[str, Any] = {"type": "boolean", "unit": "", "minimum": None, "maximum": None, "options": []}
BODIES: dict[str, dict[str, Any]] = {
    "rename_program": {"name": "Other"},
    "arm_program": {"on": False},
    "start_thread": {"text": "Why so?", "anchor": {"kind": "program"}},
    "answer_thread": {"text": "So."},
    "change_my_name": {"name": "Ada Meyer"},
    "choose_my_mail": {"wanted": True},
    "comment_on_run": {"text": "Why so?", "t_s": 1.5},
    "change_thread": {"resolved": True},
    "change_comment": {"text": "How so?"},
    "read_expression": {"value": None, "step": ""},
    "draw_script": {"text": ""},
    "answer_question": {"value": True},
    "let_robot_in": {"robot": "nobody"},
    "open_zone": {"minutes": 60},
    "call_method": {"method": "none"},
    "plan_route": {"from": [1, 1], "to": [2, 2]},
    "plan_routes": {"pairs": []},
    "look_at_description": {"text": ""},
    "confirm_topic": {"topic": "a"},
    "withdraw_topic": {"topic": "a"},
    "wait_until_stored": {"seen": ""},
    "save_function": {"program": "{program}", "function": "f", "name": "F"},
    "look_at_promotion": {"site": "{slug}"},
    "promote_program": {"site": "{slug}", "name": "Elsewhere"},
    "fork_function": {"function": "{function}", "name": "F anew"},
    "change_function": {"visibility": "everyone"},
    "add_test": {"text": "name: It is quick\nthen:\n- within_s: 60\n"},
    "look_at_test": {"text": ""},
    "import_tests": {"text": ""},
    "say_change_is_meant": {"code": "turned", "meant": False},
    "write_test": {"text": "name: It ends\nthen:\n- ends: well\n"},
    "use_robot_map": {"device": "{device}", "version": 1, "replaces": 1},
    "set_review_rule": {"approvals": 0, "least_role": "author"},
    "give_verdict": {"version": 1, "verdict": "approved"},
    "set_retention": {"runs": 30, "rehearsals": None, "calls": 0},
    "restore_map": {"version": 1, "replaces": 1},
    "add_place": {"name": "Other", "kind": "point", "x": 1, "y": 1},
    "edit_place": {"name": "Table"},
    "add_zone": {"name": "Aisle", "rule": "keep_out", "points": [[0, 0], [1, 0], [1, 1]]},
    "edit_zone": {"name": "Gate"},
    "add_obstacle": {"x": 1, "y": 1},
    "move_obstacle": {"x": 1, "y": 1},
    "reserve_device": {"id": "mixer-9"},
    "create_program": {"name": "New"},
    "copy_version": {"name": "Copy"},
    "look_at_restoring": {"everything": True},
    "restore_version": {"everything": True},
    "make_changes": {"changes": []},
    "create_token": {"name": "Other", "scopes": ["read"]},
    "change_member": {"role": "operator"},
    "make_invitation": {"role": "viewer"},
    "look_at_invitation": {"code": "{code}"},
    "make_wall_screen": {"name": "Hall 1"},
    "open_wall_screen": {"code": "{wall_code}"},
    "accept_invitation": {"code": "{code}"},
    "join_as_new": {"code": "{code}", "name": "New One", "email": "new-one@vipo.example", "password": "four odd words"},
    "sign_in": {"email": "a", "password": "b"},
    "finish_provider_sign_on": {"state": "none"},
    "set_factor_rule": {"demanded_from": None},
    "begin_linking": {"provider": "none"},
    "begin_second_factor": {"password": "not this one"},
    **{
        name: {"password": "not this one", "code": "123456"}
        for name in ("confirm_second_factor", "renew_recovery_codes", "turn_off_second_factor")
    },
    "change_my_password": {"old": "not this one", "new": "another-horse-9"},
}
"""What is sent, where an empty object does not say enough; a name in braces stands for an id."""
QUERIES = {
    "ask": "?query=ASK+%7B%7D",
    "show_property_history": "?property=jobStatus",
    "compare_versions": "?old=1",
    "list_version_runs": "?oldest=1&newest=9",
}
QUERIES |= {"list_remedies": "?code=no_room&target=none"}
QUERIES |= {"compare_function": "?old=1", "compare_function_sides": "?old=1&site={slug}"}


def make_one_of_each(slug: str) -> dict[str, str]:
    """Make one of each thing at a site that has a map; return what stands in addresses that name them."""
    site, device = Site.objects.get(slug=slug), f"robot-{slug}"
    _make_robot(device, slug)
    drawn = document({}, functions={"f": {"name": "Greet", "parameters": []}})
    program = editor.create_program(site=slug, name="Mix", document=drawn).id
    editor.pin_version(program_id=program, user=None, message="")
    function = editor.save_function(
        site=slug, program_id=program, function="f", said=editor.Said("Greet"), user=None
    ).id
    content = {"document": editor.get_document(program_id=program), "compiled": editor.get_compiled(program_id=program)}
    begun = {"created_at": NOW, "started_at": NOW}
    run = Run.objects.create(site=site, number=1, program=program, program_name="Mix", **begun, **content)
    call = Command.objects.create(
        id=uuid4(), site=site, position=1, device=device, method="mix", by="Me", send_after=NOW, created_at=NOW
    )
    table = services.PlaceChange(name="Table", kind="point", x=1.5, y=1.5)
    gate = services.ZoneChange(name="Gate", rule="keep_out", points=((1.0, 1.0), (2.0, 1.0), (2.0, 2.0)))
    made: dict[str, Any] = {
        "program": program,
        "zone_id": services.add_zone(site=slug, zone=gate).id,
        "obstacle": add_obstacle(site=slug, x=1.0, y=1.0, size_m=0.5).id,
        "place_id": services.add_place(site=slug, place=table).id,
        "run": run.pk,
        "question": Question.objects.create(run=run, number=1, text="Go?", answer=ANSWER, asked_at=NOW).pk,
        "rehearsal": Rehearsal.objects.create(site=site, program=program, created_at=NOW, **content).pk,
        "letter": DeadLetter.objects.create(
            site=site, run=run, target=f"run:{run.pk}", event={"type": "resume", "by": ""}, error="Broken.", at=NOW
        ).pk,
        "function": function,
        "call": call.pk,
        "alert_id": DeviceAlert.objects.create(device_id=device, code="offline", first_at=NOW, last_at=NOW).pk,
    }
    made |= _make_comment(program)
    _make_paces(site, device)
    ends = "name: It ends\nthen:\n- ends: well\n"
    made["test"] = ProgramTest.objects.create(
        program_id=program, name="It ends", text=ends, created_at=NOW, edited_at=NOW
    ).pk
    made["test_run"] = TrialRun.objects.create(program_id=program, digest="0" * 64, total=1, created_at=NOW).pk
    named = {"device_id": device, "device": device, "thing": device, "slug": slug, "site": slug, "number": "1"}
    named |= {"version": "1", "name": "jobStatus", "action": "mix", "session": "0", "provider": "none", "sign_on": "0"}
    named["method"] = "mix"
    named |= _make_guest(site)
    return {**named, **{name: str(key) for name, key in made.items()}}


def _make_paces(site: Site, device: str) -> None:
    """Let a method have been measured, and its pace be in use."""
    of = {"site": site, "device": device, "method": "mix"}
    for _ in range(5):
        Measurement.objects.create(**of, command=uuid4(), real_s=12, predicted_s=10, at=NOW)
    Calibration.objects.create(**of, pace=1.1, count=5, at=NOW)


def _make_comment(program: UUID) -> dict[str, Any]:
    """Begin a thread in a program, as somebody who has left since."""
    thread = CommentThread.objects.create(program_id=program, anchor={"kind": "program"}, started_at=NOW, last_at=NOW)
    return {"thread": thread.pk, "comment": Comment.objects.create(thread=thread, text="Why?", written_at=NOW).pk}


def _make_guest(site: Site) -> dict[str, str]:
    """Make a member of a site, and an invitation to it; return what addresses and bodies name them by."""
    email = f"guest-{site.slug}@vipo.example"
    guest = services.create_user(email=email, password="correct-horse-9", display_name=f"Guest of {site.name}")
    services.set_member(site=site.slug, email=guest.email, role="viewer")
    maker = User.objects.filter(memberships__site=site, memberships__role="admin").first()
    assert maker is not None
    now = datetime.now(UTC)
    made, code = make_invitation(site=site.slug, by=maker, wanted=Wanted("viewer", 7, 5), now=now)
    wall, wall_code = make_wall_screen(site=site.slug, by=maker, name="East wall", days=7, now=now)
    walls = {"wall_screen": str(wall.id), "wall_code": wall_code}
    return {"person": str(guest.pk), "invitation": str(made.id), "code": code, **walls}


def _make_robot(name: str, site: str) -> None:
    """Let a robot be approved at a site, and send a map."""
    methods = (MethodSpec("mix", f"vipo/v1/dev/{name}/down/mix"),)
    properties = (PropertySpec("jobStatus", "number", "PERCENT"),)
    services.expect_device(site=site, device_id=name, credential=f"the key of {name} ".ljust(32, "."), approved=False)
    describe(replace(ROBOT, id=name, site=site, methods=methods, properties=properties))
    Device.objects.filter(pk=name).update(lifecycle="approved", properties={"jobStatus": 0})
    for payload in write_grid(RobotGrid(4, 3, 1.0, (0.0, 0.0, 0.0), bytes(12)), 1, 1):
        services.ingest_map_part(device_id=name, payload=payload, at=datetime.now(UTC))


@contextmanager
def undone() -> Iterator[None]:
    """Take back what happens in it."""
    with transaction.atomic():
        yield
        transaction.set_rollback(True)


def ask_each(client: Client, ids: dict[str, str]) -> Iterator[tuple[str, Any]]:
    """Yield the name of each operation and what it answers, each asked as if it were the first."""
    cookies = SimpleCookie(client.cookies)
    for path, calls in OPERATIONS.items():
        for method, call in calls.items():
            with undone():
                yield call["operationId"], ask(client, method, path, call["operationId"], ids)
            client.cookies = SimpleCookie(cookies)


def ask(client: Client, method: str, path: str, name: str, ids: dict[str, str]) -> Any:
    """Ask for an operation in a way that it understands, with these ids in its address and body."""
    path = path.format(**ids) + QUERIES.get(name, "").format(**ids)
    if name == "post_query":
        return client.post(path, "ASK {}", content_type="application/sparql-query")
    if name == "upload_site":
        return client.post(path, {"name": "New", "yaml": SimpleUploadedFile("map.yaml", b"image: a.pgm")})
    if name in ("upload_map", "look_at_map"):
        files = {"yaml": SimpleUploadedFile("map.yaml", b"image: a.pgm")}
        present = client.get(f"/api/sites/{ids['slug']}/map/cells")
        return client.post(path, files, headers={"If-Match": present.headers.get("ETag", '"none"')})
    if method == "get":
        return client.get(path)
    sent = {
        key: value.format(**ids) if isinstance(value, str) else value for key, value in BODIES.get(name, {}).items()
    }
    form = "application/merge-patch+json" if name == "patch_thing" else "application/json"
    return getattr(client, method)(path, json.dumps(sent), content_type=form)
