"""Versions told as compatible or breaking, what devices lack, who holds a function, copies at other sites, search."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import pytest
from django.apps import apps

from editor import services as editor
from editor.models import LibraryFunction, LibraryPart, LibraryVersion
from registry import services as registry
from registry.models import Device
from tests.kit.programs import document, operate, step
from tests.kit.sign_in import add_person, patch_json, post_json, signed_in
from tests.kit.sites import describe, make_hall

pytestmark = pytest.mark.django_db
F = ("f", "body")


@pytest.fixture
def hall(db: None) -> str:
    """A site with a mixer; another, Shed, without devices; `elsewhere` is author at both."""
    slug = make_hall()
    registry.create_site(name="Shed", slug="shed")
    add_person("elsewhere")
    for site in ("hall", "shed"):
        registry.set_member(site=site, email="elsewhere@vipo.example", role="author")
    describe()
    Device.objects.update(lifecycle="approved")
    return slug


def mixing(*parameters: dict[str, Any], more: dict[str, Any] | None = None, **function: Any) -> dict[str, Any]:
    """Return a program with a function that lets the mixer mix."""
    steps = {"mix": operate("mixer1", "mix", F), **(more or {})}
    return document(steps, functions={"f": {"name": "mixPaint", "parameters": [*parameters], **function}})


def save(content: dict[str, Any], person: str = "author", site: str = "hall", **said: Any) -> Any:
    """Save the function of a program that is made of this content."""
    program = str(editor.create_program(site=site, name="Source", document=content).id)
    body = {"program": program, "function": "f", "name": "mixPaint", **said}
    return post_json(signed_in(person), f"/api/sites/{site}/library", body)


MINUTES = {"name": "minutes", "type": "number", "unit": "MIN"}


def test_a_version_is_told_as_compatible_or_breaking_when_it_is_saved(hall: str) -> None:
    first = save(mixing(MINUTES)).json()
    assert first["reasons"] is None
    second = save(mixing(MINUTES, {"name": "shade", "type": "text", "default": "teal"})).json()
    assert [(r["code"], r["name"], r["breaks"]) for r in second["reasons"]] == [("parameter_added", "shade", False)]
    third = save(mixing({**MINUTES, "unit": "SEC"})).json()
    assert [(r["code"], r["name"], r["old"], r["new"], r["breaks"]) for r in third["reasons"]] == [
        ("parameter_unit", "minutes", "MIN", "SEC", True),
        ("parameter_gone", "shade", "text", "", True),
    ]
    client = signed_in("viewer")
    listed = client.get(f"/api/library/{first['id']}/versions").json()
    assert [(each["number"], any(r["breaks"] for r in each["reasons"] or [])) for each in listed] == [
        (3, True),
        (2, False),
        (1, False),
    ]
    compared = client.get(f"/api/library/{first['id']}/comparison?old=1").json()
    assert (compared["old"]["version"], compared["new"]["version"]) == (1, 3)
    assert [reason["code"] for reason in compared["reasons"]] == ["parameter_unit"]
    same = client.get(f"/api/library/{first['id']}/comparison?old=2&new=2").json()
    assert same["reasons"] == []


@pytest.mark.parametrize("asked", ["old=0", "old=1&new=9", "old=-1", "old=99999999999999999999", "old=1&new=1e9"])
def test_versions_that_are_none_are_refused_by_name(hall: str, asked: str) -> None:
    function = save(mixing()).json()["id"]
    answer = signed_in("viewer").get(f"/api/library/{function}/comparison?{asked}")
    assert answer.status_code in (404, 422)
    assert answer.headers["Content-Type"].startswith("application/problem+json")


def test_programs_that_hold_an_older_version_are_told_whether_the_newest_is_breaking(hall: str) -> None:
    function = save(mixing(MINUTES)).json()["id"]
    held = mixing(MINUTES, source={"library": function, "version": 1})
    held["steps"]["call"] = step("call", function="f", args={"minutes": 3})
    program = editor.create_program(site=hall, name="Holds", document=held)

    def told() -> list[str]:
        found = editor.get_compiled(program_id=program.id)["diagnostics"]
        return [each["code"] for each in found if each["field"] == "source"]

    save(mixing(MINUTES, {"name": "shade", "type": "text", "default": "teal"}))
    assert told() == ["newer_version"]
    save(mixing({**MINUTES, "unit": "SEC"}))
    assert told() == ["signature_changed"]


def test_a_list_tells_what_the_devices_of_a_site_lack(hall: str) -> None:
    robot = {"lift": operate("", "lift", F)}
    robot["lift"]["params"]["device"] = {"role": "robot"}
    save(mixing(), visibility="everyone")
    save(mixing(more=robot), name="liftPaint", visibility="everyone")
    client = signed_in("elsewhere")
    here = client.get("/api/library?fits=hall").json()
    assert {each["name"]: [(n["of"], n["methods"]) for n in each["lacks"]] for each in here} == {
        "mixPaint": [],
        "liftPaint": [("robot", ["lift"])],
    }
    there = client.get("/api/library?fits=shed").json()
    assert {each["name"]: [(n["of"], n["methods"]) for n in each["lacks"]] for each in there} == {
        "mixPaint": [("machine", ["mix"])],
        "liftPaint": [("machine", ["mix"]), ("robot", ["lift"])],
    }
    assert [each["lacks"] for each in client.get("/api/library").json()] == [None, None]
    assert signed_in("stranger").get("/api/library?fits=hall").status_code == 404
    assert signed_in("stranger").get(f"/api/library/{here[0]['id']}?fits=hall").status_code == 404


def test_those_that_devices_can_do_are_found_behind_many_that_they_cannot(hall: str) -> None:
    robot = {"lift": operate("", "lift", F)}
    robot["lift"]["params"]["device"] = {"role": "robot"}
    lifting = save(mixing(more=robot), name="liftPaint", visibility="everyone").json()["id"]
    one = LibraryFunction.objects.get(pk=lifting)
    version = one.versions.get()
    for number in range(70):
        one.pk, one.name = None, f"liftPaint {number:02}"
        one._state.adding = True
        one.save()
        version.pk, version.function = None, one
        version.save()
    save(mixing(), name="mixPaint", visibility="everyone")
    client = signed_in("elsewhere")
    found = client.get("/api/library?fits=hall&only_fitting=true&limit=5")
    assert [(each["name"], each["lacks"]) for each in found.json()] == [("mixPaint", [])]
    assert "Link" not in found.headers
    assert client.get("/api/library?fits=shed&only_fitting=true").json() == []
    assert client.get("/api/library?fits=hall&only_fitting=true&q=lift").json() == []
    Device.objects.update(lifecycle="retired")
    assert client.get("/api/library?fits=hall&only_fitting=true").json() == []


def test_a_next_version_that_needs_something_else_is_found_by_what_it_needs(hall: str) -> None:
    save(document({"w": step("wait", F, duration=1)}, functions={"f": {"name": "rest", "parameters": []}}), name="rest")
    client = signed_in("author")

    def fitting() -> list[str]:
        return [each["name"] for each in client.get("/api/library?fits=hall&only_fitting=true").json()]

    assert fitting() == ["rest"]
    robot = {"lift": operate("", "lift", F)}
    robot["lift"]["params"]["device"] = {"role": "robot"}
    assert save(mixing(more=robot), name="rest").json()["version"] == 2
    assert fitting() == []


def test_only_what_fits_is_asked_with_a_site_that_one_sees(hall: str) -> None:
    refused = signed_in("author").get("/api/library?only_fitting=true")
    assert refused.status_code == 422
    assert "Name with fits the site" in refused.content.decode()
    assert signed_in("stranger").get("/api/library?fits=hall&only_fitting=true").status_code == 404


def test_what_functions_from_before_need_is_noted_when_the_database_is_brought_up_to_date(hall: str) -> None:
    function = save(mixing(MINUTES)).json()["id"]
    demands = LibraryFunction.objects.get(pk=function).demands
    assert "mix" in demands
    LibraryFunction.objects.update(demands="[]")
    import_module("editor.migrations.0012_library_demands").note_demands(apps, None)
    assert LibraryFunction.objects.get(pk=function).demands == demands


def test_who_holds_a_function_is_shown_as_far_as_one_sees_their_sites(hall: str) -> None:
    function = save(mixing(), visibility="everyone").json()["id"]
    for site, name, version in (("hall", "Here", 1), ("shed", "There", 1)):
        held = mixing(source={"library": function, "version": version})
        program = editor.create_program(site=site, name=name, document=held)
        editor.get_compiled(program_id=program.id)
    inner = {"g": {"name": "mixPaint", "parameters": [], "source": {"library": function, "version": 1}}}
    outer = document(
        {"call": step("call", F, function="g", args={})}, functions={"f": {"name": "order", "parameters": []}, **inner}
    )
    save(outer, name="order")
    save(mixing())

    def uses(person: str) -> Any:
        return signed_in(person).get(f"/api/library/{function}/uses").json()

    both = uses("elsewhere")
    assert [(each["name"], each["site"], each["versions"]) for each in both["programs"]] == [
        ("Here", "hall", [1]),
        ("Source", "hall", [1]),
        ("There", "shed", [1]),
    ]
    assert [(each["name"], each["versions"]) for each in both["functions"]] == [("order", [1])]
    assert both["hidden"] == 0
    one = uses("viewer")
    assert [each["name"] for each in one["programs"]] == ["Here", "Source"]
    assert one["hidden"] == 1
    none = uses("stranger")
    assert (none["programs"], none["functions"], none["hidden"]) == ([], [], 3)
    patch_json(signed_in("author"), f"/api/library/{function}", {"visibility": "site"})
    assert signed_in("stranger").get(f"/api/library/{function}/uses").status_code == 404


def test_a_copy_keeps_its_origin_and_tells_how_far_behind_it_is(hall: str) -> None:
    function = save(mixing(MINUTES), visibility="everyone", description="Mixes.").json()["id"]
    client = signed_in("elsewhere")
    made = post_json(client, "/api/sites/shed/library/forks", {"function": function, "name": "mixPaint"})
    assert made.status_code == 201
    fork = made.json()
    assert (fork["site"], fork["version"], fork["description"], fork["mine"]) == ("shed", 1, "Mixes.", True)
    assert fork["origin"] == {"id": function, "name": "mixPaint", "site": "hall", "version": 1, "newest": 1}
    save(mixing())
    assert client.get(f"/api/library/{fork['id']}").json()["origin"]["newest"] == 2
    again = post_json(client, "/api/sites/shed/library/forks", {"function": function, "name": "mixPaint"})
    assert (again.status_code, again.json()["code"]) == (409, "name_taken")
    patch_json(signed_in("author"), f"/api/library/{function}", {"visibility": "me"})
    assert client.get(f"/api/library/{fork['id']}").json()["origin"] is None
    gone = post_json(client, "/api/sites/shed/library/forks", {"function": function, "name": "Other"})
    assert gone.status_code == 404
    assert LibraryFunction.objects.count() == 2


def test_what_was_brought_in_and_is_saved_under_another_name_keeps_its_origin(hall: str) -> None:
    function = save(mixing()).json()["id"]
    changed = mixing(MINUTES, source={"library": function, "version": 1})
    assert save(changed, name="mixLonger").json()["origin"]["id"] == function
    assert save(changed).json()["origin"] is None
    for source in ({"library": "nobody", "version": 1}, {"library": function, "version": 99}):
        assert save(mixing(source=source), name=f"mix{source['version']}{source['library']}").json()["origin"] is None


@pytest.mark.parametrize(
    ("query", "found"),
    [
        ("mix", {"mixPaint", "stack"}),
        ("MIXPAINT", {"mixPaint"}),
        ("mischen", {"mixPaint", "stack"}),
        ("mischt Farbe", {"mixPaint"}),
        ("mixer", {"mixPaint", "stack"}),
        ("carries", {"stack"}),
        ("carry boxes", {"stack"}),
        ("transportieren", {"stack"}),
        ("Kiste", {"stack"}),
        ("grün", {"stack"}),
        ("blau", set()),
        ("ausharten", set()),
        ("paint carry", set()),
        ("%", {"mixPaint", "stack"}),
        ("_", set()),
        ("", {"mixPaint", "stack"}),
    ],
)
def test_functions_are_found_by_what_they_do_in_both_languages(hall: str, query: str, found: set[str]) -> None:
    save(mixing())
    places = {"source": {"device": "mixer1"}, "target": {"device": "mixer1"}}
    carry = {"c": step("pick_and_drop", F, role="robot", object="box", quantity=1, **places)}
    drawn = document(carry, functions={"f": {"name": "stack", "parameters": []}})
    save(drawn, name="stack", description="Trägt grüne Kisten.")
    answer = signed_in("viewer").get("/api/library", {"q": query})
    assert {each["name"] for each in answer.json()} == found


def test_a_description_that_is_changed_is_found(hall: str) -> None:
    function = save(mixing()).json()["id"]
    patch_json(signed_in("author"), f"/api/library/{function}", {"description": "For the spring collection"})
    client = signed_in("viewer")
    assert [each["id"] for each in client.get("/api/library", {"q": "springs"}).json()] == [function]
    assert len(client.get("/api/library", {"q": "mix"}).json()) == 1


def test_functions_from_before_are_described_when_the_database_is_brought_up_to_date(hall: str) -> None:
    function = save(mixing(MINUTES)).json()["id"]
    inner = {"g": {"name": "mixPaint", "parameters": [], "source": {"library": function, "version": 1}}}
    call = {"call": step("call", F, function="g", args={})}
    save(document(call, functions={"f": {"name": "order", "parameters": []}, **inner}), name="order")
    LibraryVersion.objects.update(signature={})
    LibraryFunction.objects.update(found_by="")
    LibraryPart.objects.all().delete()
    migration = import_module("editor.migrations.0011_library_signatures")
    migration.describe_versions(apps, None)
    migration.note_parts(apps, None)
    kept = LibraryVersion.objects.get(function=function).signature
    assert kept["parameters"] == [{"name": "minutes", "type": "number", "unit": "MIN"}]
    assert [(need["of"], need["methods"]) for need in kept["needs"]] == [("machine", ["mix"])]
    assert " mischen" in LibraryFunction.objects.get(pk=function).found_by
    assert [(str(part.function_id), part.number) for part in LibraryPart.objects.all()] == [(function, 1)]


def test_roles_and_zones_that_a_function_names_are_saved_with_it(hall: str) -> None:
    steps = {"go": step("move", F, role="porter", to={"device": "mixer1"}), "clean": step("cover", F, zone="z")}
    zone = {"name": "Wet", "rule": "slow", "points": [[0, 0], [1, 0], [1, 1]], "speed_m_s": 0.2}
    roles = {"porter": {"name": "Porter", "can": ["move"]}, "other": {"name": "Other", "can": []}}
    drawn = document(
        steps, functions={"f": {"name": "go", "parameters": []}}, roles=roles, zones={"z": zone, "y": zone}
    )
    definition = save(drawn, name="go").json()["definition"]
    assert (list(definition["roles"]), list(definition["zones"])) == (["porter"], ["z"])


def test_two_versions_are_compared_as_programs_of_a_site(hall: str) -> None:
    more = {
        "wait": step("wait", F, "5V", duration=3),
        "look": step("if", F, "7V", condition={"op": ">", "args": [2, 1]}),
    }
    function = save(mixing(MINUTES)).json()["id"]
    save(mixing(MINUTES, more={**more, "inner": step("wait", ("look", "then"), duration=1)}))
    told = signed_in("viewer").get(f"/api/library/{function}/sides?site=hall&old=1").json()
    assert {(each["root"], each["id"], each["kind"]) for each in told["difference"]["constructs"]} == {
        ("steps", name, "added") for name in ("wait", "look", "inner")
    }
    assert told["old"]["document"]["steps"]["mix"]["place"] == ["program", "body", "1V"]
    assert told["new"]["document"]["steps"]["inner"]["place"][:2] == ["look", "then"]
    assert told["new"]["document"]["start_pos"] == [2.2, pytest.approx(-3.9)]
    assert list(told["new"]["document"]["parameters"].values()) == [MINUTES]
    assert (told["old"]["problem"], told["new"]["errors"]) == ("", 0)
    assert told["new"]["compiled"]["numbers"]["wait"] == "2"


def test_sides_are_for_members_who_see_the_function(hall: str) -> None:
    function = save(mixing(), visibility="site").json()["id"]
    path = f"/api/library/{function}/sides"
    assert signed_in("viewer").get(f"{path}?site=shed&old=1").status_code == 404
    add_person("far")
    registry.create_site(name="Far", slug="far")
    registry.set_member(site="far", email="far@vipo.example", role="viewer")
    assert signed_in("far").get(f"{path}?site=far&old=1").status_code == 404
    for asked in ("old=9", "old=0", "old=-1", "old=99999999999999999999", "old=1&new=7", "old=x", ""):
        assert signed_in("viewer").get(f"{path}?site=hall&{asked}").status_code in (404, 422), asked
