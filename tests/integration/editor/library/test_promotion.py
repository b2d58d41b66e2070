"""Programs promoted to another site: bound by what devices describe, holes where nobody fits, the origin kept."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import pytest

from editor import services as editor
from editor.documents.shared_document import SharedDocument
from editor.documents.store import Change, append_changes, load_document
from editor.reviews.reviews import give_verdict
from registry import services as registry
from registry.models import Device, Site
from tests.kit.programs import document, operate, step
from tests.kit.sign_in import ROLES, add_person, find_person, post_json, signed_in
from tests.kit.sites import MIXER, ROBOT, describe, make_hall
from vipo_device.protocol.description import MethodSpec, Pose

pytestmark = pytest.mark.django_db


def make_device(site: str, like: Any, name: str, *methods: str, **more: Any) -> None:
    """Make an approved device of a site."""
    described = [MethodSpec(method, f"vipo/v1/dev/{name}/down/{method}") for method in methods]
    describe(replace(like, id=name, name=more.pop("called", name), methods=tuple(described), **more))
    Device.objects.filter(pk=name).update(lifecycle="approved", site=Site.objects.get(slug=site))


@pytest.fixture
def hall(db: None) -> str:
    """Hall has a mixer, an oven and a robot; Shed mixers of other names, a robot, no oven; `both` draws at both."""
    slug = make_hall()
    registry.create_site(name="Shed", slug="shed")
    add_person("both")
    for site in ("hall", "shed"):
        registry.set_member(site=site, email="both@vipo.example", role="author")
    make_device("hall", MIXER, "mixer1", "mix", called="Mixer", pose=Pose(1.0, 1.0))
    make_device("hall", MIXER, "oven1", "cure", called="Oven")
    make_device("hall", ROBOT, "robot1", "move", "pick", "drop")
    make_device("shed", MIXER, "stirrer7", "mix", "stir", called="Mixer", pose=Pose(4.0, 3.0))
    make_device("shed", MIXER, "stirrer8", "mix", called="Other", properties=())
    make_device("shed", ROBOT, "robot7", "move", "pick", "drop")
    return slug


def drawing() -> dict[str, Any]:
    until = {"op": "<", "args": [{"property": ["oven1", "jobStatus"]}, 40]}
    steps = {
        "go": {**step("move", order="1V", role="carrier", to={"device": "mixer1"}), "pos": [1.5, 1.0]},
        "mix": operate("mixer1", "mix"),
        "cure": operate("oven1", "cure"),
        "wait": step("wait", order="4V", until=until),
        "aside": step("move", order="5V", role="robot", to={"point": [1, 1]}, route=[[1, 2]]),
        "home": step("move", order="6V", role="robot", to={"place": "yard"}),
    }
    roles = {"carrier": {"name": "Carrier", "device": "robot1"}}
    zone = {"name": "Wet", "rule": "slow", "points": [[0, 0], [1, 0], [1, 1]], "speed_m_s": 0.2}
    return document(steps, roles=roles, zones={"z": zone})


def make_program() -> str:
    return str(editor.create_program(site="hall", name="Order", document=drawing()).id)


def promote(program: str, person: str = "both", **more: Any) -> Any:
    return post_json(signed_in(person), f"/api/programs/{program}/promotion", {"site": "shed", "name": "Order", **more})


def make_pair() -> tuple[str, str]:
    """Return a program, and the one that was made from it at Shed."""
    program = make_program()
    return program, str(promote(program).json()["id"])


def test_who_stands_for_whom_is_proposed_by_what_devices_describe(hall: str) -> None:
    answer = post_json(signed_in("both"), f"/api/programs/{make_program()}/promotion/look", {"site": "shed"})
    assert answer.status_code == 200
    look = answer.json()
    assert {each["name"]: each["proposed"] for each in look["bindings"]} == {
        "robot1": "robot7",
        "Mixer": "stirrer7",
        "Oven": None,
        "yard": None,
    }
    oven = next(each for each in look["bindings"] if each["name"] == "Oven")
    assert (oven["need"]["methods"], oven["need"]["readings"]) == (["cure"], ["jobStatus"])
    assert {each["id"] for each in oven["candidates"]} == {"stirrer7", "stirrer8"}
    assert not any(each["fits"] for each in oven["candidates"])
    assert (look["points"], look["zones"]) == (1, 1)
    assert len(editor.list_programs(site="shed")) == 0


def test_a_program_is_made_there_bound_and_what_has_no_match_is_a_marked_hole(hall: str) -> None:
    program = make_program()
    answer = promote(program)
    assert answer.status_code == 201
    made = answer.json()
    assert (made["site"], made["name"]) == ("shed", "Order")
    drawn = editor.get_document(program_id=made["id"])
    params = {name: each["params"] for name, each in drawn["steps"].items()}
    assert drawn["roles"] == {"carrier": {"name": "Carrier", "device": "robot7"}}
    assert params["go"] == {"role": "carrier", "to": {"device": "stirrer7"}}
    assert params["mix"]["device"] == {"device": "stirrer7"}
    assert "device" not in params["cure"]
    assert "until" not in params["wait"]
    assert params["aside"] == {"role": "robot"}
    assert params["home"] == {"role": "robot"}
    assert drawn["zones"] == {}
    assert drawn["steps"]["go"]["pos"] == [4.5, 3.0]
    marked = {each["step"] for each in editor.get_compiled(program_id=made["id"])["diagnostics"]}
    assert {"cure", "wait", "aside", "home"} <= marked
    told = [each["code"] for each in editor.get_compiled(program_id=made["id"])["diagnostics"] if each["step"] == "mix"]
    assert told == ["offline_device"]


def test_the_origin_is_kept_and_shown_to_who_sees_its_site(hall: str) -> None:
    program = make_program()
    made = promote(program).json()["id"]
    origin = signed_in("both").get(f"/api/programs/{made}/origin").json()["origin"]
    assert origin == {"id": program, "name": "Order", "site": "hall", "version": 1, "newest": 1}
    add_person("local")
    registry.set_member(site="shed", email="local@vipo.example", role="viewer")
    assert signed_in("local").get(f"/api/programs/{made}/origin").json() == {"origin": None, "copies": []}
    there = signed_in("both").get(f"/api/programs/{program}/origin").json()
    assert (there["origin"], [(each["id"], each["site"], each["version"]) for each in there["copies"]]) == (
        None,
        [(made, "shed", 1)],
    )
    assert signed_in("viewer").get(f"/api/programs/{program}/origin").json() == {"origin": None, "copies": []}
    assert signed_in("viewer").get(f"/api/programs/{made}/origin").status_code == 404
    editor.delete_program(program_id=program)
    assert signed_in("both").get(f"/api/programs/{made}/origin").json() == {"origin": None, "copies": []}


def test_what_was_chosen_holds_and_null_leaves_a_hole(hall: str) -> None:
    made = promote(make_program(), chosen={"mixer1": "stirrer8", "robot1": None, "oven1": "stirrer7"}).json()
    drawn = editor.get_document(program_id=made["id"])
    assert drawn["steps"]["mix"]["params"]["device"] == {"device": "stirrer8"}
    assert drawn["steps"]["cure"]["params"]["device"] == {"device": "stirrer7"}
    assert drawn["roles"]["carrier"] == {"name": "Carrier", "can": ["move"]}


def test_devices_and_places_that_are_defaults_of_parameters_are_bound_as_well(hall: str) -> None:
    parameters = {
        "Mixer": {"type": "device", "default": "mixer1"},
        "Oven": {"type": "device", "default": "oven1"},
        "Dock": {"type": "place", "default": "dockA"},
        "Shelf": {"type": "place", "default": "mixer1"},
    }
    mix = step("operate", device={"param": "Mixer"}, method="mix", args={})
    cure = step("operate", order="2V", device={"param": "Oven"}, method="cure", args={})
    drawn = document({"mix": mix, "cure": cure}, parameters=parameters)
    program = str(editor.create_program(site="hall", name="Order", document=drawn).id)
    look = post_json(signed_in("both"), f"/api/programs/{program}/promotion/look", {"site": "shed"}).json()
    assert {each["id"]: (each["kind"], each["proposed"]) for each in look["bindings"]} == {
        "mixer1": ("device", "stirrer7"),
        "oven1": ("device", None),
        "dockA": ("place", None),
    }
    made = promote(program).json()
    assert editor.get_document(program_id=made["id"])["parameters"] == {
        "Mixer": {"type": "device", "default": "stirrer7"},
        "Oven": {"type": "device"},
        "Dock": {"type": "place"},
        "Shelf": {"type": "place", "default": "stirrer7"},
    }


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ({"chosen": {"mixer1": "robot7"}}, 422),
        ({"chosen": {"mixer1": "mixer1"}}, 422),
        ({"chosen": {"nobody": "stirrer7"}}, 422),
        ({"chosen": {"mixer1": 7}}, 422),
        ({"chosen": ["mixer1"]}, 422),
        ({"name": ""}, 422),
        ({"name": "x" * 500}, 422),
        ({"site": "hall"}, 422),
        ({"site": "nowhere"}, 404),
        ({"site": None}, 422),
        ({"chosen": {str(n): None for n in range(2001)}}, 422),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_is_made(hall: str, body: dict[str, Any], status: int) -> None:
    answer = promote(make_program(), **body)
    assert answer.status_code == status, answer.content
    assert answer.headers["Content-Type"].startswith("application/problem+json")
    assert len(editor.list_programs(site="shed")) == 0
    assert len(editor.list_programs(site="hall")) == 1


def test_it_takes_an_author_at_both_sites(hall: str) -> None:
    program = make_program()
    for person in (*ROLES, "stranger"):
        expected = {"viewer": 403, "commenter": 403, "operator": 403, "author": 404, "admin": 404, "stranger": 404}
        assert promote(program, person).status_code == expected[person], person
    registry.set_member(site="shed", email="both@vipo.example", role="operator")
    assert promote(program).status_code == 403
    assert len(editor.list_programs(site="shed")) == 0


def test_odd_documents_are_promoted_without_a_fault(hall: str) -> None:
    values: list[Any] = [None, 7, "x", [], {}, {"device": 7}, {"device": ""}, {"property": ["a"]}, {"op": "x"}]
    steps = {
        f"s{number}": {"kind": "operate", "place": ["program", "body", f"{number}V"], "params": {"device": value}}
        for number, value in enumerate(values)
    }
    drawn = {**drawing(), "steps": steps, "roles": {"r": {"device": "gone"}, "q": {}}}
    program = str(editor.create_program(site="hall", name="Odd", document=drawn).id)
    assert promote(program).status_code == 201, json.dumps(drawn)


def test_a_copy_is_compared_with_what_it_was_made_from_by_who_sees_both(hall: str) -> None:
    program, made = make_pair()
    client = signed_in("both")
    for old, new in ((f"{program}:1", "draft"), (f"{program}:draft", f"{made}:draft")):
        told = client.get(f"/api/programs/{made}/comparison", {"old": old, "new": new})
        assert told.status_code == 200, told.content
        changed = {each["id"]: each["kind"] for each in told.json()["difference"]["constructs"]}
        assert changed["mix"] == "changed"  # another mixer stands there
        assert "added" not in changed.values()
    there = client.get(f"/api/programs/{program}/comparison", {"old": "1", "new": f"{made}:draft"})
    assert there.json()["difference"]["constructs"]


@pytest.mark.parametrize("side", ["{other}:", "{other}:x", "x:1", ":1", "{other}:0001x", "{other}:1:2", "{other}:-1"])
def test_what_is_no_side_is_refused(hall: str, side: str) -> None:
    program, made = make_pair()
    asked = {"old": side.format(other=program), "new": "draft"}
    assert signed_in("both").get(f"/api/programs/{made}/comparison", asked).status_code == 422


def test_who_does_not_see_the_other_site_compares_nothing_of_it(hall: str) -> None:
    program, made = make_pair()
    add_person("local2")
    registry.set_member(site="shed", email="local2@vipo.example", role="author")
    for side in (f"{program}:1", f"{program}:draft", f"{program}:99"):
        answer = signed_in("local2").get(f"/api/programs/{made}/comparison", {"old": side, "new": "draft"})
        assert answer.status_code == 404


def test_a_program_made_elsewhere_names_who_drew_it_here_and_who_promoted_it(hall: str) -> None:
    drawer, maker = find_person("author"), find_person("both")
    program = editor.create_program(site="hall", name="Order", document=drawing(), user=drawer).id
    made = promote(str(program)).json()["id"]
    version = editor.pin_version(program_id=made, user=maker)
    assert sorted(each.id for each in version.authors) == sorted([drawer.pk, maker.pk])


def test_an_approval_here_counts_elsewhere_only_of_who_may_approve_there(hall: str) -> None:
    drawer, reviewer, maker = find_person("author"), find_person("admin"), find_person("both")
    program = editor.create_program(site="hall", name="Order", document=drawing(), user=drawer).id
    editor.pin_version(program_id=program, user=drawer)
    give_verdict(program_id=program, user=reviewer, number=1, verdict="approved")
    shared = SharedDocument(load_document(str(program)).updates)
    before = shared.state()
    shared.change_to({**shared.to_json(), "steps": {"w": step("wait", duration=1)}})
    append_changes(str(program), [Change(maker.pk, shared.encode(before))], datetime.now(UTC))
    strange = editor.pin_version(program_id=promote(str(program)).json()["id"], user=None)
    registry.set_member(site="shed", email=reviewer.email, role="author")
    known = editor.pin_version(program_id=promote(str(program), name="Again").json()["id"], user=None)
    assert sorted(each.id for each in strange.authors) == sorted([drawer.pk, maker.pk])
    assert [each.id for each in known.authors] == [maker.pk]
