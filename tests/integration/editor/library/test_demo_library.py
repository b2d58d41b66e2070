"""The library of the demo: not empty, sound on the factory's devices, and the same when it is set up again."""

from __future__ import annotations

import json
from typing import Any

import pytest

from editor.language import compile_document
from editor.language.signatures.fit import find_lacks
from editor.language.signatures.signature import signature_of
from editor.models import LibraryFunction
from editor.services import seed_library
from registry import services as registry
from tests.kit.demo_site import factory
from tests.kit.files import ROOT
from tests.kit.programs import document, step
from tests.kit.sign_in import add_person, signed_in

FUNCTIONS = json.loads((ROOT / "examples" / "library" / "painting-factory.json").read_text())["functions"]
GIVEN: dict[str, Any] = {"number": 2, "text": "Clean?", "device": {"device": "paintMixer01"}}


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda function: str(function["name"]))
def test_each_function_is_sound_on_the_devices_of_the_factory(function: dict[str, Any]) -> None:
    for definition in function["versions"]:
        body = definition["function"]
        arguments = {given["name"]: GIVEN[given["type"]] for given in body["parameters"]}
        call = step("call", function=definition["id"], args=arguments)
        functions = {**definition["functions"], definition["id"]: body}
        before = step("move", order="0V", role="robot", to={"device": "itemInventory01"})
        drawn = document(
            {**definition["steps"], "before": before, "theCall": call}, functions=functions, roles=definition["roles"]
        )
        drawn["format"] = definition["format"]
        found = [each.code for each in compile_document(drawn, factory()).diagnostics if each.severity == "error"]
        assert found == []
        assert find_lacks(signature_of(definition, factory().devices).needs, factory().devices) == ()


@pytest.mark.django_db
def test_the_library_is_filled_once_and_found_in_both_languages() -> None:
    registry.create_site(name="Factory", slug="factory")
    for _ in range(2):
        seed_library(site="factory")
    rows = LibraryFunction.objects.values_list("name", "last_version")
    assert dict(rows) == {each["name"]: len(each["versions"]) for each in FUNCTIONS}
    add_person("somebody")
    registry.set_member(site="factory", email="somebody@vipo.example", role="viewer")
    found = signed_in("somebody").get("/api/library", {"q": "aushärten"}).json()
    assert "cureBox" in {each["name"] for each in found}
    function = LibraryFunction.objects.get(name="mixPaint").pk
    reasons = signed_in("somebody").get(f"/api/library/{function}").json()["reasons"]
    assert [(each["code"], each["name"], each["breaks"]) for each in reasons] == [("parameter_added", "times", False)]
