"""People who move, add and delete steps at once: every copy ends with the same program, and no step is lost."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pycrdt import Doc, Map

from editor.documents.shared_document import SharedDocument, encode_document
from editor.language import compile_document, compiled_to_json, plan_to_json
from editor.language.document.outline import branches_of, make_outline
from tests.kit.demo_site import factory

quick = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
FRAMES = ("while", "if", "try", "parallel")
KINDS = (*FRAMES, "wait")
KEYS = ("1", "5", "V", "VV", "a")


def _step(kind: str, place: list[str] | None) -> dict[str, Any]:
    params = {"condition": True, "seconds": 1, "duration": 1, "branches": ["a", "b"], "kinds": []}
    return {"kind": kind, "place": place, "pos": [0, 0], "params": params}


@st.composite
def programs(draw: st.DrawFn) -> dict[str, Any]:
    """Draw a sound program of some frames and leaves and a function."""
    steps: dict[str, Any] = {}
    for index in range(draw(st.integers(3, 8))):
        kind = draw(st.sampled_from(KINDS))
        steps[f"s{index}"] = _step(kind, _somewhere(draw, [*steps], steps))
    functions = {"f": {"name": "tidy", "parameters": []}}
    rest: dict[str, Any] = {"roles": {}, "parameters": {}, "zones": {}}
    return {"format": 1, "start_pos": None, "steps": steps, "functions": functions, **rest}


def _somewhere(draw: st.DrawFn, parents: list[str], steps: dict[str, Any]) -> list[str]:
    """Draw a place in one of the branches there are, also in the step itself or below it: circles are wanted."""
    frames = [name for name in parents if steps[name]["kind"] in FRAMES]
    parent = draw(st.sampled_from(["program", "f", *frames]))
    inner = ("body",) if parent in {"program", "f"} else branches_of(steps[parent]["kind"], steps[parent]["params"])
    return [parent, draw(st.sampled_from(inner)), draw(st.sampled_from(KEYS))]


@dataclass
class Copy:
    """One person's copy of the document."""

    number: int
    base: bytes
    document: Doc[Any] = field(init=False)
    sent: list[bytes] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.document = Doc(client_id=self.number)
        self.document.get("steps", type=Map)
        self.document.apply_update(self.base)

    def steps(self) -> dict[str, Any]:
        steps: dict[str, Any] = SharedDocument([self.document.get_update()]).to_json()["steps"]
        return steps

    def change(self, edits: list[tuple[str, Any]]) -> None:
        """Carry out one gesture: a new step, a new place, or a removal each, all in one transaction."""
        before = self.document.get_state()
        shared = self.document.get("steps", type=Map)
        with self.document.transaction():
            for name, value in edits:
                if value == "remove":
                    del shared[name]
                elif name in shared:
                    shared[name]["place"] = value
                else:
                    shared[name] = Map({**value, "params": Map(value["params"])})
        self.sent.append(self.document.get_update(before))

    def hear_of(self, other: Copy) -> None:
        """Take over all that another copy has and this one lacks, as the room sends it."""
        self.document.apply_update(other.document.get_update(self.document.get_state()))


def _gesture(draw: st.DrawFn, copy: Copy, fresh: str) -> list[tuple[str, Any]]:
    """Draw what somebody does with the program as they see it."""
    steps = copy.steps()
    names = sorted(steps)
    what = draw(st.sampled_from(["move", "move", "move", "many", "draft", "swap", "add", "delete", "apart"]))
    if not names or what == "add":
        return [(fresh, _step(draw(st.sampled_from(KINDS)), _somewhere(draw, names, steps)))]
    name = draw(st.sampled_from(names))
    if what == "delete":
        return [(name, "remove")]
    if what == "draft":
        return [(name, None)]
    inside = [each for each in names if (steps[each]["place"] or [""])[0] == name]
    if what == "apart":
        return [*((each, ["program", "body", "5"]) for each in inside), (name, "remove")]
    if what == "swap":
        other = {"then": "else", "else": "then"}
        return [
            (each, [name, other.get(branch, branch), order])
            for each in inside
            for _, branch, order in [steps[each]["place"]]
        ]
    several = draw(st.sets(st.sampled_from(names), min_size=1, max_size=3)) if what == "many" else {name}
    return [(each, _somewhere(draw, names, steps)) for each in sorted(several)]


@st.composite
def sessions(draw: st.DrawFn) -> list[bytes]:
    """Draw two to four people at work, who hear of each other now and then; returns all that was sent, shuffled."""
    base = encode_document(draw(programs()))
    people = [Copy(number, base) for number in range(1, draw(st.integers(2, 4)) + 1)]
    for moment in range(draw(st.integers(2, 10))):
        person = draw(st.sampled_from(people))
        edits = _gesture(draw, person, f"n{moment}")
        if edits:
            person.change(edits)
        listener = draw(st.sampled_from(people))
        if draw(st.booleans()) and listener is not person:
            listener.hear_of(person)
    return draw(st.permutations([base, *(update for person in people for update in person.sent)]))


def _in_other_orders(updates: list[bytes]) -> list[SharedDocument]:
    late = SharedDocument(updates[: len(updates) // 2])
    late.apply(SharedDocument(updates).encode(late.state()))
    return [SharedDocument(updates), SharedDocument(updates[::-1]), late]


@quick
@given(sessions())
def test_all_copies_read_the_same_program(updates: list[bytes]) -> None:
    read = set()
    for document in _in_other_orders(updates):
        compiled = compile_document(document.to_json(), factory())
        plan = None if compiled.plan is None else plan_to_json(compiled.plan)
        read.add(json.dumps([compiled_to_json(compiled), plan], sort_keys=True, default=str))
    assert len(read) == 1


@quick
@given(sessions())
def test_no_step_is_lost_and_none_stands_twice(updates: list[bytes]) -> None:
    document = SharedDocument(updates).to_json()
    compiled = compile_document(document, factory())
    assert sorted(compiled.order) == sorted(document["steps"])
    outline = make_outline(document)
    standing = [name for members in outline.children.values() for name in members]
    assert sorted([*standing, *outline.drafts]) == sorted(document["steps"])


@quick
@given(sessions())
def test_a_step_stands_where_its_place_says_or_is_a_draft(updates: list[bytes]) -> None:
    document = SharedDocument(updates).to_json()
    outline = make_outline(document)
    for (parent, branch), members in outline.children.items():
        for name in members:
            assert document["steps"][name]["place"][:2] == [parent, branch]
        orders = [(document["steps"][name]["place"][2], name) for name in members]
        assert orders == sorted(orders)
