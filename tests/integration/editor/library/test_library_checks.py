"""What the checks know of the library: its functions and versions, as they are in the database."""

from __future__ import annotations

from typing import Any

import pytest

from editor.documents.shared_document import empty_document
from editor.language import compile_document
from editor.language.signatures.signature import signature_of
from editor.language.site.signature import Port, Signature, signature_to_json
from editor.language.site.surroundings import LibraryFacts
from editor.models import LibraryFunction, LibraryUse, LibraryVersion
from editor.programs.checking import build_surroundings, changes_programs, fingerprint_of
from editor.services import create_program, get_compiled
from registry import services as registry
from registry.models import Site

pytestmark = pytest.mark.django_db


@pytest.fixture
def function() -> LibraryFunction:
    registry.create_site(name="Hall", slug="hall")
    return LibraryFunction.objects.create(site=Site.objects.get(slug="hall"), name="rest")


def add_version(function: LibraryFunction, number: int, *parameters: str) -> None:
    given = [{"name": name, "type": "number", "unit": ""} for name in parameters]
    definition = {"id": "f", "function": {"name": "rest", "parameters": given}, "functions": {}, "steps": {}}
    signature = signature_to_json(signature_of(definition, {}))
    LibraryVersion.objects.create(
        function=function, number=number, definition=definition, script="", signature=signature
    )


def document(function: LibraryFunction, version: int) -> dict[str, Any]:
    source = {"library": str(function.pk), "version": version}
    return {
        **empty_document(),
        "functions": {"f": {"name": "rest", "parameters": [], "source": source}},
        "steps": {
            "call": {"kind": "call", "place": ["program", "body", "V"], "params": {"function": "f", "args": {}}},
            "wait": {"kind": "wait", "place": ["f", "body", "V"], "params": {"duration": 1}},
        },
    }


def codes(function: LibraryFunction, version: int) -> list[str]:
    compiled = compile_document(document(function, version), build_surroundings(site="hall"))
    return [diagnostic.code for diagnostic in compiled.diagnostics]


def test_the_checks_know_each_version_with_its_parameters(function: LibraryFunction) -> None:
    add_version(function, 1)
    add_version(function, 2, "minutes")
    assert build_surroundings(site="hall").library == {
        str(function.pk): LibraryFacts("rest", {1: Signature(), 2: Signature((Port("minutes", "number"),))})
    }


def test_a_newer_version_is_told_and_changes_what_programs_were_checked_against(function: LibraryFunction) -> None:
    add_version(function, 1)
    before = fingerprint_of(build_surroundings(site="hall"))
    assert codes(function, 1) == []
    add_version(function, 2)
    assert codes(function, 1) == ["newer_version"]
    assert codes(function, 2) == []
    add_version(function, 3, "minutes")
    assert codes(function, 2) == ["signature_changed"]
    assert codes(function, 9) == ["version_gone"]
    assert fingerprint_of(build_surroundings(site="hall")) != before


def test_a_program_may_hold_a_function_of_another_site_without_a_word(function: LibraryFunction) -> None:
    add_version(function, 1)
    registry.create_site(name="Works", slug="works")
    program = create_program(site="works", name="Borrows", user=None, document=document(function, 1))
    assert get_compiled(program_id=program.id)["diagnostics"] == []
    assert [use.program_id for use in function.uses.all()] == [program.id]


def test_a_source_that_is_no_id_is_no_use(function: LibraryFunction) -> None:
    program = create_program(site="hall", name="Odd", user=None, document=document(LibraryFunction(pk="odd"), 1))
    get_compiled(program_id=program.id)
    assert not LibraryUse.objects.exists()


def test_open_programs_are_looked_at_again_when_the_library_changes() -> None:
    assert changes_programs({"type": "library"})
    assert not changes_programs({"type": "programs"})
