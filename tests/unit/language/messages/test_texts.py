from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from string import Formatter

import pytest

from editor.language import checks
from editor.language.expressions.value_types import TYPE_WORDS
from editor.language.messages.de import FIX_TEXTS_DE, TEXTS_DE
from editor.language.messages.diagnostics import Fix, Problem, TextArguments, put_into_words
from editor.language.messages.en import FIX_TEXTS, NOT_NOW, TEXTS
from editor.language.messages.phrases import (
    Amounts,
    Driver,
    Options,
    Phrase,
    Plural,
    Quoted,
    Refusal,
    Robot,
    Said,
    Span,
    number_text,
)
from editor.language.parsing import script


def placeholders(text: str) -> set[str]:
    return {name for _, name, _, _ in Formatter().parse(text) if name}


def test_both_languages_have_the_same_codes() -> None:
    assert TEXTS_DE.keys() == TEXTS.keys()
    assert FIX_TEXTS_DE.keys() == FIX_TEXTS.keys()
    assert TEXTS.keys() >= NOT_NOW


def test_both_languages_have_the_same_placeholders() -> None:
    english = {code: placeholders(text) for code, (_, text) in TEXTS.items()}
    assert {code: placeholders(text) for code, text in TEXTS_DE.items()} == english
    assert {code: placeholders(text) for code, text in FIX_TEXTS_DE.items()} == {
        code: placeholders(text) for code, text in FIX_TEXTS.items()
    }


@pytest.mark.parametrize("code", TEXTS)
def test_every_sentence_ends_and_has_a_severity(code: str) -> None:
    severity, text = TEXTS[code]
    assert severity in {"error", "warning"}
    assert text.endswith((".", "}"))
    assert TEXTS_DE[code].endswith((".", "}"))


@pytest.mark.parametrize(
    ("phrase", "english", "german"),
    [
        (Span(1, 30, "min"), "1 to 30 min", "1 bis 30 min"),
        (Span(0.5, None, "m", ": "), ": 0.5 m or more", ": mindestens 0,5 m"),
        (Span(None, 80, "%"), "80% or less", "höchstens 80%"),
        (Span(None, None, "m", ": "), "", ""),
        (Amounts(0), "1 or more", "1 oder mehr"),
        (Amounts(1), "1", "1"),
        (Amounts(2), "1 or 2", "1 oder 2"),
        (Amounts(6), "1 to 6", "1 bis 6"),
        (Plural("box"), "boxes", "Objekte „box“"),
        (Plural("battery"), "batteries", "Objekte „battery“"),
        (Plural(""), "objects", "Objekte"),
        (Options(("box", "can"), "or"), "box or can", "box oder can"),
        (Options(()), "nothing", "nichts"),
        (Robot("TurtleBot 1"), "TurtleBot 1", "TurtleBot 1"),
        (Robot("Arm", sort=True), "An Arm", "Ein Arm"),
        (Robot("", sort=True), "A robot", "Ein Roboter"),
        (Driver("carrier", bound=False), "the robot “carrier”", "den Roboter „carrier“"),
        (Said("A number"), "A number", "Eine Zahl"),
        (Said("“and”"), "“and”", "„and“"),
        (Quoted("<"), "“<”", "„<“"),
        (Said("The quantity"), "The quantity", "Die Menge"),
        (Refusal("Write self.end()."), "Write self.end().", "Schreiben Sie self.end()."),
        (Refusal("Call it oven_2."), "Call it oven_2.", "Nennen Sie es oven_2."),
        (Refusal("“import os”"), "“import os”", "„import os“"),
        (Refusal("Something new."), "Something new.", "Something new."),
    ],
)
def test_a_phrase_is_said_in_both_languages(phrase: Phrase, english: str, german: str) -> None:
    assert (phrase.say("en"), phrase.say("de")) == (english, german)


def test_numbers_have_the_comma_of_their_language() -> None:
    assert [number_text(2.5, "en"), number_text(2.5, "de"), number_text(100.0, "de")] == ["2.5", "2,5", "100"]


def test_a_problem_is_put_into_words_in_both_languages() -> None:
    fix = Fix("set_to", "a", "quantity", 1, {"value": 1})
    args: TextArguments = {"things": Plural("box"), "robot": Robot("TurtleBot", sort=True), "range": Amounts(2)}
    said = put_into_words(Problem("missing_quantity", "a", "quantity", args, fix), 4)
    assert said.messages == {
        "en": "Enter how many boxes to carry. A TurtleBot carries 1 or 2 at a time.",
        "de": "Geben Sie ein, wie viele Objekte „box“ zu tragen sind. Ein TurtleBot trägt 1 oder 2 auf einmal.",
    }
    assert (said.message, said.severity, said.when, said.line) == (said.messages["en"], "error", "ever", 4)
    assert [fix.label_in("en"), fix.label_in("de")] == ["Set to 1", "Auf 1 setzen"]


def test_what_only_the_site_as_it_is_prevents_is_told_apart() -> None:
    assert put_into_words(Problem("offline_device", args={"device": "Curing Oven"}), None).when == "now"
    assert put_into_words(Problem("retired_device", args={"device": "Curing Oven"}), None).when == "ever"


PARSERS = sorted(Path(script.__file__).parent.glob("[!_]*.py"))


def refusals(path: Path) -> Iterator[str]:
    """Yield what a module of the parser says when it refuses, with `abc` for what comes from the script."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Refused":
            for said in node.args[1:]:
                if isinstance(said, ast.Constant):
                    yield str(said.value)
                elif isinstance(said, ast.JoinedStr):
                    yield "".join(str(part.value) if isinstance(part, ast.Constant) else "abc" for part in said.values)


@pytest.mark.parametrize("path", PARSERS, ids=lambda path: path.stem)
def test_what_the_parser_says_has_its_german(path: Path) -> None:
    quoted = {"The variable abc": "The variable “abc”", "A change of abc": "A change of “abc”"}
    said = [quoted.get(english, english) for english in refusals(path)]
    assert [english for english in said if Refusal(english).say("de") == english] == []


CHECKERS = sorted(Path(checks.__file__).parent.glob("[!_]*.py"))


@pytest.mark.parametrize("path", CHECKERS, ids=lambda path: path.stem)
def test_what_the_checks_speak_of_has_its_german(path: Path) -> None:
    subjects = re.compile(r"(The|A|An|How) [a-z ]+")
    nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    said = [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    found = [text for text in said if subjects.fullmatch(text)]
    assert [text for text in found if Said(text).say("de") == text] == []


def test_every_type_has_its_german() -> None:
    assert [word for word in TYPE_WORDS.values() if Said(word).say("de") == word] == []
