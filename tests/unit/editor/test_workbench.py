"""What a child process says of a program, given what changed, is what a check of the whole document says."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from editor.compiling.frames import HEAD, decode_body, encode_frame
from editor.compiling.job_delta import ChildKnowledge, Wanted
from editor.compiling.workbench import Found, Workbench
from editor.documents.shared_document import SharedDocument, empty_document, migrate_document
from editor.language import compile_document, compiled_to_json
from editor.language.site.surroundings import Surroundings
from editor.programs.summary import summary_of
from editor.rooms.compiled_form import CompiledForm, encode_check
from editor.rooms.stream import BEGINNING, Entry
from tests.unit.language.test_incremental import SITES, edited

Json = dict[str, Any]


class Process:
    """A web process with one program, and its child process without the pipe between them."""

    def __init__(self, name: str, document: SharedDocument) -> None:
        self.name = name
        self.document = document
        self.form = CompiledForm()
        self.knowledge, self.bench = ChildKnowledge(), Workbench()
        self.sizes: list[int] = []

    def check(self, site: Surroundings, program: str = "p") -> Json:
        wanted = Wanted(program, lambda: self.document, site, lambda: self.form.revision, self.form.way_from)
        document, job = self.document, self.knowledge.job(wanted)
        frame = encode_frame(job)
        self.sizes.append(len(frame))
        found: Found = self.bench.check(decode_body(frame[HEAD.size :]))
        self.knowledge.take(wanted, document, job, found)
        assert found.summary == summary_of(self.document.to_json(), compile_document(self.document.to_json(), site))
        return dict(found.said)


def tell(said: Json, number: int, *processes: Process) -> None:
    """Have a check heard from the stream by all."""
    note = encode_check(json.loads(json.dumps(said)), after=BEGINNING, more=False, against="")
    for process in processes:
        assert process.form.hear(Entry(str(number), "any", note))


def whole(document: SharedDocument, site: Surroundings) -> Json:
    form = compiled_to_json(compile_document(document.to_json(), site))
    form.pop("revision")
    return json.loads(json.dumps(form))


def shown(process: Process) -> Json:
    assert process.form.now is not None
    return {name: value for name, value in process.form.now.items() if name != "revision"}


@settings(deadline=None, max_examples=80)
@given(edited(), st.data())
def test_the_form_is_that_of_the_whole_document_whoever_of_two_checks_and_whatever_is_lost(
    looks: Sequence[tuple[Json, Surroundings]], data: st.DataObject
) -> None:
    document = SharedDocument()
    here, there = Process("here", document), Process("there", document)
    for number, (plain, site) in enumerate(looks, 1):
        document.change_to({**empty_document(), **migrate_document(plain)})
        process = data.draw(st.sampled_from((here, there)))
        if data.draw(st.booleans()):  # it was killed, or forgot
            process.knowledge, process.bench = ChildKnowledge(), Workbench()
        if data.draw(st.booleans()):  # what it says comes too late and is dropped
            process.check(site)
        tell(process.check(site), number, here, there)
        assert shown(here) == shown(there) == whole(document, site)


def test_an_edit_of_a_large_program_costs_few_bytes() -> None:
    steps = {
        f"s{number}": {"kind": "wait", "place": ["program", "body", f"{number:05}"], "params": {"duration": 5}}
        for number in range(1000)
    }
    document = SharedDocument()
    document.change_to({**empty_document(), "steps": steps})
    process = Process("here", document)
    tell(process.check(SITES[0]), 1, process)
    for number in range(3):
        document.change_to({**document.to_json(), "steps": {**steps, f"new{number}": steps["s5"]}})
        tell(process.check(SITES[0]), number + 2, process)
    assert process.sizes[0] > 50_000
    assert max(process.sizes[1:]) < 1500


def test_a_document_that_was_built_anew_is_sent_anew() -> None:
    document = SharedDocument()
    document.change_to({**empty_document(), "steps": {"a": _wait("a")}})
    process = Process("here", document)
    tell(process.check(SITES[0]), 1, process)
    process.document = SharedDocument()
    process.document.change_to({**empty_document(), "steps": {"b": _wait("b")}})
    tell(process.check(SITES[0]), 2, process)
    assert shown(process)["order"] == ["b"]


def test_of_many_programs_those_used_least_are_forgotten() -> None:
    document = SharedDocument()
    document.change_to({**empty_document(), "steps": {"a": _wait("a")}})
    process = Process("here", document)
    for number in range(40):
        process.check(SITES[0], f"p{number}")
    assert len(process.knowledge.programs) == 30
    assert len(process.bench._known) == 30
    assert "p39" in process.bench._known
    assert "p0" not in process.bench._known


def _wait(order: str) -> Json:
    return {"kind": "wait", "place": ["program", "body", order], "params": {"duration": 5}}
