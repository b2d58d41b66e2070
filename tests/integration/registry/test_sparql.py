"""SPARQL over a site: what is answered, what is refused, and that a hostile query is ended and harms nobody."""

from __future__ import annotations

import csv
import io
import json
import subprocess
import threading
from dataclasses import replace
from typing import Any
from urllib.parse import urlencode
from xml.etree import ElementTree

import pytest
from django.test import Client

from registry.bounds.slots import Claim
from registry.sparql import queries
from registry.sparql.engine import Refused, answer, check_query, graph_of_devices
from tests.kit.sign_in import ROLES, find_person, signed_in
from tests.kit.sites import MIXER, ROBOT, come, describe, say
from vipo_device.protocol.description import PropertySpec

ADDRESS = "/api/sites/hall/sparql"
NAMES = "SELECT ?id ?name WHERE { ?d dct:identifier ?id ; dct:title ?name } ORDER BY ?id"
EVERYTHING = "{ ?a ?b ?c . ?d ?e ?f . ?g ?h ?i . ?j ?k ?l . FILTER(?a != ?d) }"


@pytest.fixture
def asked(hall: str) -> Client:
    describe(replace(MIXER, properties=(PropertySpec("heat", "number", "DEG_C", minimum=0),)))
    describe(ROBOT)
    come()
    say(props={"heat": 61.5})
    return signed_in("viewer")


def values(answer: Any) -> list[tuple[Any, ...]]:
    body = answer.json()
    return [tuple(row[name]["value"] for name in body["head"]["vars"]) for row in body["results"]["bindings"]]


def test_a_site_can_be_asked_what_it_has_and_how_it_is(asked: Client) -> None:
    answer = asked.get(ADDRESS, {"query": NAMES})
    assert answer["Content-Type"] == "application/sparql-results+json; charset=utf-8"
    assert values(answer) == [("mixer1", "Mixer One"), ("robot1", "Robot One")]
    hot = """SELECT ?id ?value ?status WHERE {
        ?d dct:identifier ?id ; vipo:status ?status ; td:hasPropertyAffordance ?p .
        ?p td:name "heat" ; vipo:value ?value FILTER(?value > 60) }"""
    assert values(asked.get(ADDRESS, {"query": hot})) == [("mixer1", "61.5", "pending")]


def test_results_come_as_csv_and_graphs_as_turtle_too(asked: Client) -> None:
    answer = asked.get(ADDRESS, {"query": NAMES, "format": "csv"})
    assert answer["Content-Type"] == "text/csv; charset=utf-8"
    rows = list(csv.reader(io.StringIO(answer.content.decode())))
    assert rows == [["id", "name"], ["mixer1", "Mixer One"], ["robot1", "Robot One"]]
    assert (
        asked.post(ADDRESS, {"query": NAMES}).json()["detail"].startswith("Send the query as application/sparql-query")
    )
    answer = asked.post(
        ADDRESS, "ASK { ?d a vipo:Robot }", content_type="application/sparql-query", headers={"Accept": "*/*"}
    )
    assert answer.json()["boolean"] is True
    named = "CONSTRUCT { ?d dct:title ?n } WHERE { ?d dct:title ?n ; a vipo:Robot }"
    answer = asked.post(
        ADDRESS, f"query={named}", content_type="application/x-www-form-urlencoded", headers={"Accept": "text/turtle"}
    )
    assert answer["Content-Type"] == "text/turtle; charset=utf-8"
    assert '<urn:vipo:device:robot1> dct:title "Robot One" .' in answer.content.decode()


@pytest.mark.parametrize(
    ("accept", "forms"),
    [
        ("text/csv;q=0.1, application/sparql-results+xml", ["xml", "csv"]),
        ("application/rdf+xml, text/*;q=0.1", ["turtle", "csv"]),
        ("application/rdf+xml", []),
    ],
)
def test_the_dearest_form_comes_first(
    asked: Client, accept: str, forms: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    jobs: list[Any] = []

    def run(job: bytes) -> tuple[int, bytes]:
        jobs.append(json.loads(job))
        return 0, b"text/csv\nx\n"

    monkeypatch.setattr(queries, "_run", run)
    told = asked.get(ADDRESS, {"query": NAMES}, headers={"Accept": accept})
    assert jobs[0]["forms"] == forms
    assert "Accept" in told["Vary"]


def test_a_result_comes_in_the_first_form_that_can_hold_it() -> None:
    graph = graph_of_devices([])
    rows, one = "SELECT ?a { BIND(1 AS ?a) }", "CONSTRUCT { <urn:a> dct:title ?a } { BIND(1 AS ?a) }"
    told = [answer(graph, *each)[0] for each in ((rows, ["turtle", "json"]), (one, ["json", "turtle"]), (one, []))]
    assert told == ["json", "turtle", "turtle"]
    with pytest.raises(Refused, match="SELECT is answered as json, xml or csv, ASK as json or xml, not as turtle"):
        answer(graph, rows, ["turtle"])
    found = ElementTree.fromstring(answer(graph, rows, ["xml"])[1])
    assert [cell.text for cell in found.iter("{http://www.w3.org/2005/sparql-results#}literal")] == ["1"]


def test_a_forms_fields_are_those_of_the_protocol(asked: Client) -> None:
    def post(**fields: str) -> Any:
        return asked.post(ADDRESS, urlencode(fields), content_type="application/x-www-form-urlencoded")

    assert post(query=NAMES, format="csv")["Content-Type"] == "text/csv; charset=utf-8"
    for refused in (post(query=NAMES, format="rdf"), post(query=NAMES, **{"named-graph-uri": "urn:a"}), post()):
        assert (refused.status_code, refused.json()["code"]) == (400, "bad_query")
    elsewhere = asked.get(ADDRESS, {"query": NAMES, "default-graph-uri": "http://127.0.0.1:1/"})
    assert elsewhere.json()["detail"].startswith("default-graph-uri and named-graph-uri are not allowed")
    assert asked.get(ADDRESS).json()["detail"].startswith("A query has 1 to 16384 characters.")


@pytest.mark.parametrize("role", [*ROLES, "stranger", "nobody"])
def test_every_member_may_ask_and_strangers_learn_nothing(
    asked: Client, role: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(queries, "_run", lambda job: (0, b"text/csv\nx\n"))
    expected = {"stranger": 404, "nobody": 401}.get(role, 200)
    assert signed_in(role).get(ADDRESS, {"query": NAMES}).status_code == expected
    answer = signed_in(role).post(ADDRESS, NAMES, content_type="application/sparql-query")
    assert answer.status_code == expected


def test_a_post_needs_the_token(asked: Client) -> None:
    client = signed_in("viewer", enforce_csrf_checks=True)
    assert client.post(ADDRESS, NAMES, content_type="application/sparql-query").status_code == 403


@pytest.mark.parametrize(
    ("query", "told"),
    [
        ("", "A query has 1 to 16384 characters. Give it as `query`."),
        ("SELECT" + " " * 16_384, "A query has 1 to 16384 characters. Give it as `query`."),
        ("SELECT ?a WHERE { SERVICE <http://127.0.0.1:1/> { ?a ?b ?c } }", "SERVICE is not allowed: "),
        ("SELECT ?a WHERE { GRAPH ?g { ?a ?b ?c } }", "The query cannot be carried out: "),
        ("SELECT ?a WHERE { ?a nope:b ?c }", "The query cannot be carried out: Unknown namespace prefix"),
    ],
)
def test_what_reaches_out_changes_something_or_is_no_query_is_refused(asked: Client, query: str, told: str) -> None:
    answer = asked.get(ADDRESS, {"query": query})
    assert (answer.status_code, answer.json()["code"]) == (400, "bad_query")
    assert answer.json()["detail"].startswith(told)


@pytest.mark.parametrize(
    ("query", "told"),
    [
        ("SELECT ?a WHERE { SERVICE <http://127.0.0.1:1/> { ?a ?b ?c } }", "SERVICE is not allowed: "),
        ("ASK { { SELECT ?a { OPTIONAL { SERVICE SILENT ?x { ?a ?b ?c } } } } }", "SERVICE is not allowed: "),
        ("ASK { FILTER NOT EXISTS { SERVICE <http://127.0.0.1:1/> { ?a ?b ?c } } }", "SERVICE is not allowed: "),
        ("SELECT ?a FROM <file:///etc/passwd> WHERE { ?a ?b ?c }", "FROM is not allowed: "),
        ("SELECT ?a FROM NAMED <http://127.0.0.1:1/> WHERE { ?a ?b ?c }", "FROM is not allowed: "),
        ("DELETE WHERE { ?a ?b ?c }", "This is no SPARQL query (SELECT, ASK, CONSTRUCT or DESCRIBE): "),
        ("LOAD <http://127.0.0.1:1/>", "This is no SPARQL query (SELECT, ASK, CONSTRUCT or DESCRIBE): "),
    ],
)
def test_the_engine_understands_queries_of_the_site_alone(query: str, told: str) -> None:
    with pytest.raises(Refused) as refusal:
        check_query(query)
    assert str(refusal.value).startswith(told)


HOSTILE = {
    "every combination": f"SELECT (COUNT(*) AS ?n) WHERE {EVERYTHING}",
    "paths without an end": "SELECT (COUNT(*) AS ?n) WHERE { ?a (!rdf:x|^!rdf:x)* ?b . ?b (!rdf:x|^!rdf:x)* ?c }",
    "a regular expression that explodes": """ASK { VALUES ?x { "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa!" }
        FILTER regex(?x, "^(a+)+$") }""",
    "texts put together for ever": f"SELECT (GROUP_CONCAT(CONCAT(STR(?a), STR(?c))) AS ?n) WHERE {EVERYTHING}",
    "texts that double": "SELECT ?z WHERE { BIND(REPLACE('" + "a" * 400 + "', 'a', '" + "b" * 400 + "') AS ?a) "
    + " ".join(f"BIND(REPLACE(?{a}, 'b', '{'b' * 400}') AS ?{b})" for a, b in zip("abc", "bcz", strict=True)) + "}",
    "brackets in brackets": "ASK { " + "{ " * 4_000 + "} " * 4_000 + "}",
    "a result without an end": f"SELECT * WHERE {EVERYTHING}",
}  # fmt: skip


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_query_is_ended_and_nothing_is_left_of_it(
    asked: Client, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(queries, "CPU_S", 0)  # the rest of the second in which the engine has started
    begun: list[subprocess.Popen[bytes]] = []
    real = subprocess.Popen

    def remember(*arguments: Any, **options: Any) -> subprocess.Popen[bytes]:
        begun.append(real(*arguments, **options))
        return begun[-1]

    monkeypatch.setattr(queries.subprocess, "Popen", remember)
    answer = asked.get(ADDRESS, {"query": HOSTILE[name]})
    assert (answer.status_code, answer.json()["code"]) in {(422, "query_too_large"), (400, "bad_query")}
    assert answer.json()["detail"].startswith(("The query ", "The result ", "This is no SPARQL query "))
    assert [process.poll() is not None for process in begun] == [True]


def test_memory_is_limited(asked: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(queries, "CPU_S", 600)
    monkeypatch.setattr(queries, "WALL_S", 600)
    monkeypatch.setattr(queries, "MEMORY_BYTES", 300_000_000)
    answer = asked.get(ADDRESS, {"query": HOSTILE["texts that double"]})
    told = "The query needs more memory than it may have. Ask for less at once."
    assert (answer.status_code, answer.json()["detail"]) == (422, told)


@pytest.mark.django_db(transaction=True)
def test_the_server_answers_others_while_a_hostile_query_runs(asked: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(queries, "CPU_S", 1)
    told: list[int] = []
    client = signed_in("operator")
    hostile = {"query": HOSTILE["a regular expression that explodes"]}
    asking = threading.Thread(target=lambda: told.append(client.get(ADDRESS, hostile).status_code))
    asking.start()
    answered = 0
    while asking.is_alive():
        assert asked.get("/api/sites/hall/devices").status_code == 200
        answered += 1
    asking.join()
    assert told == [422]
    assert answered > 5


def test_only_two_are_answered_at_once(asked: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(queries, "PATIENCE_S", 0.0)
    for other in (Claim(1000, "x"), Claim(1001, "y")):
        assert queries._slots.take(other)
    answer = asked.get(ADDRESS, {"query": NAMES})
    for other in (Claim(1000, "x"), Claim(1001, "y")):
        queries._slots.give_back(other)
    assert (answer.status_code, answer.json()["code"], answer["Retry-After"]) == (429, "too_many_queries", "5")
    assert json.loads(asked.get(ADDRESS, {"query": NAMES}).content)["head"]["vars"] == ["id", "name"]


@pytest.mark.parametrize("busy", ["hall", "elsewhere"])
def test_a_site_and_a_person_have_one_question_answered_at_a_time_and_leave_room_for_others(
    asked: Client, monkeypatch: pytest.MonkeyPatch, busy: str
) -> None:
    monkeypatch.setattr(queries, "PATIENCE_S", 0.0)
    asker = find_person("viewer").pk
    other = Claim(1000 if busy == "hall" else asker, busy)
    assert queries._slots.take(other)
    told = [signed_in(name).get(ADDRESS, {"query": NAMES}).status_code for name in ("viewer", "author")]
    queries._slots.give_back(other)
    assert told == ([429, 429] if busy == "hall" else [429, 200])
