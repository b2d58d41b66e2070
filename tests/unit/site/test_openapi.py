"""The OpenAPI file is what the API is, and its shapes are what the code makes."""

import json
from collections import Counter

import pytest
from ninja import Schema

import editor.api
import editor.shapes
import execution.program_tests.shapes
import execution.rehearsals.shapes
import execution.shapes
import registry.shapes
import vipo_site.http.openapi
from editor.language import compile_document, compiled_to_json
from editor.language.document.outline import BRANCHES, COMMENT
from editor.shapes import CompiledShape, DocumentShape, StepKind
from execution.rehearsals.program_file import rehearse_program
from execution.rehearsals.shapes import RehearsalResultShape
from tests.kit.files import ROOT
from vipo_site.cli.program_file import read_program_file
from vipo_site.http.api import api
from vipo_site.http.openapi import describe


def program(name):
    return read_program_file(ROOT / "examples" / f"{name}.json", None)


def fits(shape, value):
    """The value has the shape, and nothing besides: what is read and written again is the same."""
    plain = json.loads(json.dumps(value))
    again = shape.model_validate(plain).model_dump(mode="json", exclude_unset=True)
    assert again == plain


@pytest.fixture(scope="module")
def described():
    """The description, which takes more than a second to make."""
    return describe(api)


def test_the_committed_file_is_up_to_date(described):
    committed = (ROOT / "docs" / "openapi.json").read_text()
    assert committed == described, "docs/openapi.json is out of date: run `make openapi` and commit what it writes"


def test_two_descriptions_are_the_same_bytes(described):
    assert describe(api) == described


def has_shape(answer):
    return "$ref" in answer or (
        bool(answer.get("content")) and all(body["schema"] for body in answer["content"].values())
    )


def test_every_answer_has_a_shape(described):
    paths = json.loads(described)["paths"]
    answers = {
        (method, path, status): answer
        for path, calls in paths.items()
        for method, call in calls.items()
        for status, answer in call["responses"].items()
    }
    assert len(answers) > 80
    assert [key for key, answer in answers.items() if not has_shape(answer)] == [
        ("put", "/api/me/mail", "204"),
        ("delete", "/api/me/sessions/{session}", "204"),
        ("delete", "/api/me/sign-ons/{sign_on}", "204"),
        ("delete", "/api/programs/{program}", "204"),
        ("delete", "/api/programs/{program}/comments/{comment}", "204"),
        ("put", "/api/programs/{program}/document", "204"),
        ("put", "/api/programs/{program}/script", "204"),
        ("post", "/api/programs/{program}/stored", "204"),
        ("post", "/api/programs/{program}/tests/meant-changes", "204"),
        ("delete", "/api/programs/{program}/tests/{test}", "204"),
        ("post", "/api/programs/{program}/threads/{thread}/read", "204"),
        ("post", "/api/sign-in/providers/{provider}/logout", "204"),
        ("post", "/api/sites/{site}/zones/{zone_id}/admissions", "204"),
        ("delete", "/api/sites/{slug}/invitations/{invitation}", "204"),
        ("post", "/api/sites/{slug}/leave", "204"),
        ("delete", "/api/sites/{slug}/members/{person}/second-factor", "204"),
        ("delete", "/api/sites/{slug}/obstacles", "204"),
        ("delete", "/api/sites/{slug}/obstacles/{obstacle}", "204"),
        ("delete", "/api/sites/{slug}/places/{place_id}", "204"),
        ("patch", "/api/sites/{slug}/things/{thing}", "204"),
        ("delete", "/api/sites/{slug}/tokens/{token_id}", "204"),
        ("delete", "/api/sites/{slug}/wall-screens/{wall_screen}", "204"),
        ("delete", "/api/sites/{slug}/zones/{zone_id}", "204"),
        ("delete", "/api/sites/{slug}/zones/{zone_id}/opening", "204"),
        ("post", "/api/wall/open", "204"),
    ]


def test_no_two_shapes_have_one_name():
    modules = (
        registry.shapes,
        editor.api,
        editor.shapes,
        execution.shapes,
        execution.program_tests.shapes,
        execution.rehearsals.shapes,
        vipo_site.http.openapi,
    )
    shapes = {s for m in modules for s in vars(m).values() if isinstance(s, type) and issubclass(s, Schema)}
    assert [name for name, count in Counter(shape.__name__ for shape in shapes).items() if count > 1] == []


def test_the_kinds_of_steps_are_those_of_the_language():
    assert set(StepKind.__value__.__args__) == {*BRANCHES, COMMENT}


@pytest.mark.parametrize("name", ["pick-and-drop", "paint-order"])
def test_documents_and_compiled_programs_have_their_shape(name):
    file = program(name)
    fits(DocumentShape, file.document)
    fits(CompiledShape, compiled_to_json(compile_document(file.document, file.surroundings)))


def test_a_compiled_program_with_errors_has_its_shape():
    file = program("pick-and-drop")
    for step in file.document["steps"].values():
        step["params"].pop("quantity", None)
    compiled = compiled_to_json(compile_document(file.document, file.surroundings))
    assert compiled["diagnostics"][0]["severity"] == "error"
    fits(CompiledShape, compiled)


def test_a_rehearsals_result_has_its_shape():
    file = program("pick-and-drop")
    result = rehearse_program(file.document, file.site, driver="kinematic")
    assert result["ok"]
    fits(RehearsalResultShape, result)


def test_every_call_says_with_which_statuses_it_may_be_refused():
    paths = json.loads(describe(api))["paths"]
    statuses = {call["operationId"]: sorted(call["responses"]) for calls in paths.values() for call in calls.values()}
    always = ["400", "422", "429", "500", "503", "default"]
    assert statuses["show_me"] == sorted(["200", *always])
    assert statuses["list_sites"] == sorted(["200", "401", "403", *always])
    assert statuses["get_run"] == sorted(["200", "401", "403", "404", *always])
    assert statuses["create_program"] == sorted(["201", "401", "403", "404", "409", *always])
    assert [name for name, told in statuses.items() if not {*always} <= {*told}] == []
