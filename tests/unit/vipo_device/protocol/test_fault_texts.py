"""What people write wrong in descriptions: each fault has a code, says where, and the screens have words for it."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator
from typing import Any

import pytest

from tests.kit.files import ROOT
from tests.unit.vipo_device.descriptions.examples import THING
from vipo_device.descriptions.forms import BadDescription
from vipo_device.descriptions.reader import read
from vipo_device.protocol.fault_texts import SENTENCES
from vipo_device.protocol.faults import Fault, facts_of, fault, note

SPEAKERS = (
    "execution/gateway/gateway.py",
    "vipo_site/embedded_broker/connection.py",
    "vipo_site/embedded_broker/routing.py",
)
SOURCES = [
    *(ROOT / "registry").rglob("*.py"),
    *(ROOT / "vipo_device").rglob("*.py"),
    *(ROOT / name for name in SPEAKERS),
]
PREFIXES = """@prefix vipo: <urn:vipo:ns#> . @prefix td: <https://www.w3.org/2019/wot/td#> .
@prefix dct: <http://purl.org/dc/terms/> . @prefix qudt: <http://qudt.org/schema/qudt/> .
"""
DEVICE = f'{PREFIXES}<urn:a> a vipo:Machine ; dct:identifier "m1" ; vipo:size ( 1 1 1 ) ; vipo:location '
MESSAGE = 'id: "m1"\nlocation: [1, 2]\nsize: "small"\n'
NAMED = {**THING, "@context": [THING["@context"], {"vipo": "urn:vipo:ns#"}]}


def thing(**more: Any) -> str:
    return json.dumps({key: value for key, value in {**NAMED, **more}.items() if value is not None})


BROKEN: list[tuple[str, str, str]] = [
    ("vipo:lamp a vipo:Machine .", "rdf_prefix", "1:1"),
    ("device:\n  id: lamp01\n", "rdf_prefix", "1:1"),
    ("Das ist meine Lampe.", "rdf_subject", "1:1"),
    (f"{DEVICE}( 1 2 )", "rdf_end", "3:90"),
    (f"{DEVICE}( 1 2 )\n dct:title 'x' .", "rdf_dot", "4:2"),
    (f"{DEVICE}( 1,5 2 ) .", "rdf_commas", "3:87"),
    (f"{DEVICE}[ 1 2 ] .", "rdf_predicate", "3:86"),
    (f'{DEVICE}( "eins" 2 ) .', "rdf_number", ""),
    (f'{DEVICE}( 1 2 ) ; dct:title "A" , "B" .', "rdf_more", ""),
    (f'{DEVICE}( 1 2 ) ; td:hasPropertyAffordance [ td:name "t" ; qudt:hasUnit "°X" ] .', "no_unit", ""),
    (f'{DEVICE}( 1 2 ) ; td:hasActionAffordance [ dct:title "Los" ] .', "method_nameless", ""),
    (f'{DEVICE}( 1 2 ) ; td:hasActionAffordance [ td:name "öffnen" ] .', "method_name", ""),
    (f"{DEVICE}( 1 2 ) . <urn:b> a vipo:Robot .", "rdf_kinds", ""),
    ("<html><body>404</body></html>", "markup", ""),
    ('{"id": "m1",\n "location": [1,2],\n}', "json_key", "3:1"),
    ('{"id": "m1"\n "location": [1,2]}', "json_comma", "2:2"),
    ('{"id": "m1", "done": True}', "json_value", "1:22"),
    ('{"id": "m1",\n "location": [NaN, 2], "size": [1, 1, 1]}', "json_constant", "2:15"),
    ('{"id": "NaN",\n "location": [1e999, 2]}', "json_large", "2:15"),
    ('{"a": {"id": 1}, "id": "m1",\n "id": "m2"}', "json_twice", "2:2"),
    ('{"hello": "world"}', "rdf_no_kind", ""),
    (thing(**{"@context": None}), "rdf_no_vipo", ""),
    (json.dumps({"@context": "https://schema.org", "@type": "vipo:Machine"}), "context_unknown", ""),
    (
        json.dumps(
            {
                "@context": "urn:vipo:context",
                "@type": "vipo:Machine",
                "dct:identifier": "m1",
                "vipo:location": [1, 2],
            }
        ),
        "rdf_list",
        "",
    ),
    (thing(security=None), "td_missing_such", ""),
    (thing(title=3), "td_type", "/title"),
    (thing(properties={"t": {"type": "float", "forms": [{"href": "x"}]}}), "td_choice", "/properties/t/type"),
    (thing(**{"vipo:location": "1, 2"}), "need_numbers", "/vipo:location"),
    (thing(actions={"on": {"forms": [{"href": "http://lamp/on"}]}}), "need_mqtt", "/actions/on/forms"),
    ('id: "m1"\nlocation: 1, 2\n', "paper_value", "2:11"),
    ('id: "m1"\nlocation [1, 2]\n', "paper_line", "2:1"),
    (f"{MESSAGE}done: yes\n", "need_truth", "4:7"),
    (f"{MESSAGE}size: small\n", "said_twice", "4:7"),
    ('name: "m"\nlocation: [1, 2]\nsize: small\n', "need_id", "/id"),
    (f'{MESSAGE}methods:\n  name: "mix"\n  parameters:\n    name: "a"\n    type: "zahl"\n', "unknown_type", ""),
]


@pytest.mark.parametrize(
    ("text", "code", "place"), BROKEN, ids=[f"{n}-{code}" for n, (_, code, _) in enumerate(BROKEN)]
)
def test_a_broken_description_is_refused_with_one_fault_its_code_and_its_place(
    text: str, code: str, place: str
) -> None:
    with pytest.raises(BadDescription) as refusal:
        read(text.encode())
    (found,) = refusal.value.faults
    assert (found.code, f"{found.line}:{found.column}" if found.line else found.path) == (code, place)


@pytest.mark.parametrize(
    "text",
    [
        f"{DEVICE}( 1 2 ) ; vipo:capasity 3 ; vipo:farbe 'rot' .",
        thing(**{"vipo:capasity": 3, "vipo:farbe": "rot"}),
    ],
    ids=["turtle", "td"],
)
def test_a_term_that_vipo_does_not_have_is_left_out_and_told(text: str) -> None:
    assert [note.text for note in read(text.encode()).notes] == [
        "Left out 'vipo:capasity', which means nothing here. Perhaps vipo:capacity is meant.",
        "Left out 'vipo:farbe', which means nothing here.",
    ]


def test_a_refusal_tells_its_first_faults_as_json() -> None:
    with pytest.raises(BadDescription) as refusal:
        read(f"{MESSAGE}capacity: -1\nspeed: 99\n".encode())
    assert refusal.value.facts == facts_of(refusal.value.faults)
    assert [each["code"] for each in json.loads(json.dumps(refusal.value.facts))["faults"]] == [
        "capacity_range",
        "speed_range",
    ]
    assert len(BadDescription(*[fault("empty")] * 9).facts["faults"]) == 5


def test_what_strangers_sent_is_shown_without_what_a_terminal_would_obey() -> None:
    found = fault("left_key", key="a\x1b[2J\ud800" + "b" * 300)
    assert found.args == {"key": "a\ufffd[2J\ufffd" + "b" * 194}
    assert "\x1b" not in found.text


def test_what_was_mended_says_its_line_first() -> None:
    assert note("mended_colon", 7, key="methods") == Fault(
        "Line 7: put a colon behind methods.", 7, code="mended_colon", args={"key": "methods"}
    )


def test_the_same_may_be_said_of_a_message_and_of_a_description() -> None:
    found = fault("json_twice", 1, 2, it="The message", key="id").about("The description")
    assert found.text == "The description names the key 'id' twice. Remove one."
    assert (found.line, found.column) == (1, 2)


def given_codes() -> Iterator[str]:
    """Give the codes that the code names, also in tables of codes."""
    for path in SOURCES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and path.name != "fault_sentences.py":
                yield node.value


def test_every_sentence_is_said_somewhere() -> None:
    built = {f"{what}_{how}" for what in ("property", "method", "parameter") for how in ("name", "nameless", "twice")}
    assert set(SENTENCES) - set(given_codes()) - built == set()


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_screens_have_words_for_every_fault(language: str) -> None:
    """They have the same holes, but for what the screens say by words of their own: what a text is, and all forms."""
    catalogue = ROOT / "frontend" / "src" / "i18n" / language / "screens" / "fault.json"
    texts = json.loads(catalogue.read_text(encoding="utf-8"))
    assert set(texts) == set(SENTENCES)
    for code, sentence in SENTENCES.items():
        holes = set(re.findall(r"(?<!\{)\{(\w+)(?:!r)?\}(?!\})", sentence)) - {"it", "accepted"}
        assert set(re.findall(r"\{\{(\w+)\}\}", texts[code])) == holes, code
