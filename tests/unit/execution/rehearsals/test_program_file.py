"""A site file made into what a program is checked against and rehearsed in."""

import json

from editor.language import compile_document
from editor.language.signatures.signature import Signature
from editor.language.site.surroundings import LibraryFacts
from execution.rehearsals.program_file import read_site
from tests.kit.files import ROOT

SITE = ROOT / "examples" / "painting-factory.json"
CALLS_AN_OLD_FUNCTION = {
    "format": 2,
    "steps": {
        "c": {"kind": "call", "place": ["program", "body", "V"], "params": {"function": "f", "args": {}}},
        "w": {"kind": "wait", "place": ["f", "body", "V"], "params": {"duration": 1}},
    },
    "functions": {"f": {"name": "rest", "parameters": [], "source": {"library": "gone", "version": 1}}},
}


def site(**more):
    return {**json.loads(SITE.read_text()), "grid": None, **more}


def test_a_site_keeps_what_its_library_has():
    library = [{"id": "lib1", "name": "rest", "versions": [{"number": 2, "parameters": []}]}]
    surroundings, _, _ = read_site(site(library=library), 0)
    assert surroundings.library == {"lib1": LibraryFacts("rest", {2: Signature()})}
    assert surroundings.floor is not None


def test_a_rehearsal_holds_functions_against_the_library_of_the_file():
    library = [{"id": "gone", "name": "rest", "versions": [{"number": 2, "parameters": []}]}]
    surroundings, _, _ = read_site(site(library=library), 0)
    codes = [each.code for each in compile_document(CALLS_AN_OLD_FUNCTION, surroundings).diagnostics]
    known_nowhere, _, _ = read_site({key: value for key, value in site().items() if key != "library"}, 0)
    others = [each.code for each in compile_document(CALLS_AN_OLD_FUNCTION, known_nowhere).diagnostics]
    assert (codes, others) == (["version_gone"], [])
