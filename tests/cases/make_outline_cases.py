"""Write tests/cases/outline: documents as merges may leave them, and how every reader must read them.

What is expected is thought out by hand here, never taken from a reader: `python -m tests.cases.make_outline_cases`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent / "outline"
Children = Mapping[tuple[str, str], Sequence[str]]
BODY = ("program", "body")
EVENTS = ("program", "events")


def step(kind: str, *place: object, **params: object) -> dict[str, Any]:
    """Return a step of a document; without a place it is a draft."""
    return {"kind": kind, "place": list(place) or None, "pos": [1, -1], "params": params}


def wait(*place: object) -> dict[str, Any]:
    """Return a step that has no branches."""
    return step("wait", *place)


def loop(*place: object) -> dict[str, Any]:
    """Return a step with one branch."""
    return step("while", *place)


def case(
    what: str,
    steps: Mapping[str, Any],
    children: Children,
    drafts: Sequence[str] = (),
    unknown: Sequence[str] = (),
    functions: Sequence[str] = (),
) -> dict[str, Any]:
    """Return a case: what it shows, the document, and what is to be read from it."""
    definitions = {name: {"name": name, "parameters": []} for name in functions}
    document = {"format": 2, "start_pos": None, "steps": dict(steps), "functions": definitions}
    document |= {"roles": {}, "parameters": {}, "zones": {}}
    branches = sorted([parent, branch, list(ids)] for (parent, branch), ids in children.items() if ids)
    expected = {"children": branches, "drafts": list(drafts), "unknown": list(unknown)}
    return {"what": what, "document": document, "expected": expected}


def _order() -> dict[str, dict[str, Any]]:
    return {
        "empty": case("a program without steps", {}, {}),
        "in_order": case(
            "steps stand in the order of their keys, not of their ids",
            {"a": wait(*BODY, "C"), "b": wait(*BODY, "A"), "c": wait(*BODY, "B")},
            {BODY: "bca"},
        ),
        "same_key": case(
            "two people append at the same time: the ids decide",
            {"y": wait(*BODY, "V"), "x": wait(*BODY, "V"), "a": wait(*BODY, "W")},
            {BODY: "xya"},
        ),
        "digits_before_letters": case(
            "digits come before capital letters, these before small ones",
            {"a": wait(*BODY, "a"), "b": wait(*BODY, "Z"), "c": wait(*BODY, "9")},
            {BODY: "cba"},
        ),
        "longer_key": case(
            "a key comes before the keys that begin with it",
            {"a": wait(*BODY, "VV"), "b": wait(*BODY, "V"), "c": wait(*BODY, "V0")},
            {BODY: "bca"},
        ),
        "empty_key": case("an empty key comes first", {"a": wait(*BODY, "0"), "b": wait(*BODY, "")}, {BODY: "ba"}),
        "foreign_key": case(
            "keys of any signs are compared by their bytes",
            {"a": wait(*BODY, "ä"), "b": wait(*BODY, "~"), "c": wait(*BODY, "z")},
            {BODY: "cba"},
        ),
        "rare_signs": case(
            "a sign above U+FFFF comes after all below it, as its bytes do",
            {"a": wait(*BODY, "\U0001f600"), "b": wait(*BODY, "\uff21")},
            {BODY: "ba"},
        ),
        "ids_by_bytes": case(
            "ids, too, are compared by their bytes",
            {"\U0001f600": wait(*BODY, "V"), "\uff21": wait(*BODY, "V"), "Z": wait(*BODY, "V"), "a": wait(*BODY, "V")},
            {BODY: ["Z", "a", "\uff21", "\U0001f600"]},
        ),
        "numbers_as_ids": case(
            "ids of digits are texts: 10 comes before 9",
            {"9": wait(*BODY, "V"), "10": wait(*BODY, "V")},
            {BODY: ["10", "9"]},
        ),
    }


def _branches() -> dict[str, dict[str, Any]]:
    tops = {
        "choice": step("if", *BODY, "A"),
        "round": step("repeat", *BODY, "B"),
        "guard": step("try", *BODY, "C"),
        "each": step("for_each", *BODY, "D"),
    }
    all_tops = {BODY: ["choice", "round", "guard", "each"]}
    split = {"p": step("parallel", *BODY, "V", branches=["a", "c"])}
    return {
        "all_branches": case(
            "then, else, body, catch and finally are branches",
            {
                **tops,
                "t": wait("choice", "then", "V"),
                "e": wait("choice", "else", "V"),
                "r": wait("round", "body", "V"),
                "b": wait("guard", "body", "V"),
                "c": wait("guard", "catch", "V"),
                "f": wait("guard", "finally", "V"),
                "x": wait("each", "body", "V"),
            },
            {
                **all_tops,
                ("choice", "then"): "t",
                ("choice", "else"): "e",
                ("round", "body"): "r",
                ("guard", "body"): "b",
                ("guard", "catch"): "c",
                ("guard", "finally"): "f",
                ("each", "body"): "x",
            },
        ),
        "no_such_branch": case(
            "a branch that the parent does not have makes a draft",
            {
                **tops,
                "x": wait("choice", "body", "V"),
                "y": wait("round", "then", "V"),
                "z": wait("each", "catch", "V"),
            },
            all_tops,
            drafts="xyz",
        ),
        "inside_a_leaf": case(
            "nothing stands in a step without branches",
            {"a": wait(*BODY, "V"), "b": wait("a", "body", "V")},
            {BODY: "a"},
            drafts="b",
        ),
        "parallel_named": case(
            "a Parallel has the branches that it names",
            {**split, "x": wait("p", "c", "V"), "y": wait("p", "b", "V"), "z": wait("p", "a", "V")},
            {BODY: "p", ("p", "a"): "z", ("p", "c"): "x"},
            drafts="y",
        ),
        "parallel_unnamed": case(
            "a Parallel that names none has a and b",
            {"p": step("parallel", *BODY, "V"), "x": wait("p", "b", "V"), "y": wait("p", "c", "V")},
            {BODY: "p", ("p", "b"): "x"},
            drafts="y",
        ),
        "parallel_nonsense": case(
            "names that are no single small letters do not count; twice is once",
            {
                "p": step("parallel", *BODY, "V", branches=["b", "B", "bb", 3, None, "b", "d"]),
                "x": wait("p", "d", "V"),
                "y": wait("p", "B", "V"),
                "z": wait("p", "a", "V"),
            },
            {BODY: "p", ("p", "d"): "x"},
            drafts="yz",
        ),
        "parallel_no_list": case(
            "branches that are no list read as a and b",
            {"p": step("parallel", *BODY, "V", branches="cd"), "x": wait("p", "a", "V"), "y": wait("p", "c", "V")},
            {BODY: "p", ("p", "a"): "x"},
            drafts="y",
        ),
        "branch_taken_away": case(
            "one takes branch b away while another puts a step into it: the step is kept as a draft",
            {"p": step("parallel", *BODY, "V", branches=["a"]), "x": wait("p", "a", "V"), "y": wait("p", "b", "V")},
            {BODY: "p", ("p", "a"): "x"},
            drafts="y",
        ),
    }


def _places() -> dict[str, dict[str, Any]]:
    return {
        "no_place": case("a step without a place is a draft", {"a": wait(), "b": wait(*BODY, "V")}, {BODY: "b"}, "a"),
        "parent_gone": case(
            "one deletes a frame while another puts a step into it: the step is kept as a draft",
            {"a": wait("gone", "body", "V"), "b": wait(*BODY, "V")},
            {BODY: "b"},
            "a",
        ),
        "inside_a_draft": case(
            "what stands in a draft goes with it and is no draft of its own",
            {"a": loop(), "b": wait("a", "body", "V"), "c": wait("a", "body", "U")},
            {("a", "body"): "cb"},
            "a",
        ),
        "deep_in_a_draft": case(
            "the same over several levels",
            {"a": loop("gone", "body", "V"), "b": loop("a", "body", "V"), "c": wait("b", "body", "V")},
            {("a", "body"): "b", ("b", "body"): "c"},
            "a",
        ),
        "place_of_two": case("a place has three parts", {"a": wait("program", "body")}, {}, "a"),
        "place_of_four": case("a place has not four parts", {"a": wait(*BODY, "V", "V")}, {}, "a"),
        "place_with_number": case("the parts of a place are texts", {"a": wait(*BODY, 5)}, {}, "a"),
        "place_with_null": case("none of them is missing", {"a": wait(*BODY, None)}, {}, "a"),
        "other_branch_of_program": case(
            "a program has a body and events, nothing else", {"a": wait("program", "then", "V")}, {}, "a"
        ),
        "parent_empty": case("nothing stands in nothing", {"a": wait("", "body", "V")}, {}, "a"),
        "parent_like_a_builtin": case(
            "a parent with the name of something that every object has is still nobody",
            {"a": wait("constructor", "body", "V"), "b": wait("toString", "body", "V")},
            {},
            "ab",
        ),
        "drafts_sorted": case(
            "drafts are sorted by the bytes of their ids",
            {"b": wait(), "a": wait(), "Z": wait(), "10": wait(), "9": wait()},
            {},
            ["10", "9", "Z", "a", "b"],
        ),
    }


def _functions() -> dict[str, dict[str, Any]]:
    return {
        "function_body": case(
            "a function's body is the steps whose parent it is",
            {"a": wait("f", "body", "B"), "b": loop("f", "body", "A"), "c": wait("b", "body", "A")},
            {("f", "body"): "ba", ("b", "body"): "c"},
            functions=["f"],
        ),
        "function_gone": case(
            "one deletes a function while another draws in it: the steps are kept as drafts",
            {"a": wait("f", "body", "V"), "b": loop("f", "body", "A"), "c": wait("b", "body", "A")},
            {("b", "body"): "c"},
            "ab",
        ),
        "function_has_only_a_body": case(
            "a function has no other branch", {"a": wait("f", "catch", "V")}, {}, "a", functions=["f"]
        ),
        "two_functions": case(
            "functions do not share their steps",
            {"a": wait("f", "body", "V"), "b": wait("g", "body", "V"), "c": wait(*BODY, "V")},
            {("f", "body"): "a", ("g", "body"): "b", BODY: "c"},
            functions=["g", "f"],
        ),
        "step_and_function_alike": case(
            "where a step and a function have one id, the step is meant",
            {"f": wait(*BODY, "V"), "a": wait("f", "body", "V")},
            {BODY: "f"},
            "a",
            functions=["f"],
        ),
    }


def _circles() -> dict[str, dict[str, Any]]:
    return {
        "in_itself": case(
            "a step in itself is a draft",
            {"a": loop("a", "body", "V"), "b": wait("a", "body", "V")},
            {("a", "body"): "b"},
            "a",
        ),
        "two_in_each_other": case(
            "two people move two frames into each other: the smaller id is the draft",
            {"b": loop("a", "body", "V"), "a": loop("b", "body", "V")},
            {("a", "body"): "b"},
            "a",
        ),
        "three_in_a_circle": case(
            "the same of three; what hangs on them stays where it is",
            {
                "c": loop("b", "body", "V"),
                "b": loop("a", "body", "V"),
                "a": loop("c", "body", "V"),
                "x": wait("c", "body", "A"),
                "y": wait(*BODY, "V"),
            },
            {("a", "body"): "b", ("b", "body"): "c", ("c", "body"): "x", BODY: "y"},
            "a",
        ),
        "tail_of_a_circle": case(
            "a step that leads into a circle is not in it, even with the smallest id",
            {"a": loop("b", "body", "V"), "b": loop("c", "body", "V"), "c": loop("b", "body", "A")},
            {("b", "body"): "ca", ("c", "body"): ""},
            "b",
        ),
        "two_circles": case(
            "each circle has its own draft",
            {
                "a": loop("d", "body", "V"),
                "d": loop("a", "body", "V"),
                "b": loop("c", "body", "V"),
                "c": loop("b", "body", "V"),
            },
            {("a", "body"): "d", ("b", "body"): "c"},
            "ab",
        ),
        "circle_by_bytes": case(
            "the smallest id is the smallest by its bytes",
            {"\U0001f600": loop("\uff21", "body", "V"), "\uff21": loop("\U0001f600", "body", "V")},
            {("\uff21", "body"): ["\U0001f600"]},
            ["\uff21"],
        ),
        "broken_circle": case(
            "a branch that does not exist breaks a circle by itself",
            {"a": loop("b", "body", "V"), "b": loop("a", "then", "V")},
            {("b", "body"): "a"},
            "b",
        ),
        "circle_over_branches": case(
            "a circle through different branches is one",
            {"n": step("if", "m", "catch", "V"), "m": step("try", "n", "else", "V")},
            {("m", "catch"): "n"},
            "m",
        ),
    }


def _kinds() -> dict[str, dict[str, Any]]:
    hot = step("on_event", *EVENTS, "A")
    return {
        "unknown_kind": case(
            "a step of an unknown kind is kept and not run; what stands in it is a draft",
            {"a": step("dance", *BODY, "A"), "b": wait("a", "body", "V"), "c": wait(*BODY, "B")},
            {BODY: "c"},
            "b",
            "a",
        ),
        "unknown_kinds_sorted": case(
            "unknown ones are sorted, and kinds like builtin names are unknown, too",
            {"b": step("toString", *BODY, "A"), "a": step("", *BODY, "B")},
            {},
            (),
            "ab",
        ),
        "events": case(
            "events stand beside the program and have a body",
            {"e": hot, "d": step("on_event", *EVENTS, "B"), "x": wait("e", "body", "V"), "y": wait(*BODY, "V")},
            {EVENTS: "ed", ("e", "body"): "x", BODY: "y"},
        ),
        "step_among_events": case(
            "nothing but an event stands among the events", {"e": hot, "x": wait(*EVENTS, "V")}, {EVENTS: "e"}, "x"
        ),
        "event_among_steps": case(
            "an event stands nowhere else: neither in the program nor in a frame nor in a function",
            {
                "l": loop(*BODY, "V"),
                "p": step("on_event", *BODY, "A"),
                "q": step("on_event", "l", "body", "A"),
                "r": step("on_event", "f", "body", "A"),
            },
            {BODY: "l"},
            "pqr",
            functions=["f"],
        ),
        "comments": case(
            "a comment is for people: with or without a place it is neither a step nor a draft",
            {
                "n": step("comment"),
                "m": step("comment", *BODY, "A"),
                "a": wait(*BODY, "B"),
                "x": wait("m", "body", "A"),
            },
            {BODY: "a"},
            "x",
        ),
        "catch_switched_off": case(
            "a Try that catches nothing has no catch: what stands there is a draft",
            {
                "t": step("try", *BODY, "A", catch=False),
                "a": wait("t", "body", "V"),
                "b": wait("t", "catch", "V"),
                "c": wait("t", "finally", "V"),
            },
            {BODY: "t", ("t", "body"): "a", ("t", "finally"): "c"},
            "b",
        ),
        "leaves_of_format_2": case(
            "set, ask, notify, end, return and break are steps without branches",
            {name: step(kind, *BODY, name) for name, kind in zip("abcdef", LEAVES, strict=True)}
            | {"x": wait("a", "body", "V")},
            {BODY: "abcdef"},
            "x",
        ),
    }


LEAVES = ("set", "ask", "notify", "end", "return", "break")


def _depth() -> dict[str, dict[str, Any]]:
    def tower(height: int, *ground: str) -> dict[str, Any]:
        names = [f"t{level:02}" for level in range(height)]
        below = [ground, *((name, "body") for name in names)]
        return {name: loop(*place, "V") for name, place in zip(names, below, strict=False)}

    def branches(height: int, *ground: str) -> dict[tuple[str, str], list[str]]:
        names = [f"t{level:02}" for level in range(height)]
        return {(ground[0], ground[1]): names[:1]} | {
            (names[level], "body"): [names[level + 1]] for level in range(height - 1)
        }

    whole = tower(33, *BODY)
    cut = branches(33, *BODY)
    del cut[("t29", "body")]
    inner = tower(33, "f", "body")
    inner_cut = branches(33, "f", "body")
    del inner_cut[("t29", "body")]
    return {
        "thirty_levels": case("thirty levels are read", tower(30, *BODY), branches(30, *BODY)),
        "too_deep": case("a step deeper than thirty levels is a draft with all inside it", whole, cut, ["t30"]),
        "too_deep_in_a_function": case(
            "a function counts from its own beginning", inner, inner_cut, ["t30"], functions=["f"]
        ),
    }


def _people() -> dict[str, dict[str, Any]]:
    return {
        "moved_into_what_is_deleted": case(
            "one moves a frame into another, which somebody deletes: the whole frame is one draft",
            {"a": loop("b", "body", "V"), "x": step("if", "a", "body", "V"), "y": wait("x", "else", "V")},
            {("a", "body"): "x", ("x", "else"): "y"},
            "a",
        ),
        "wrapped_while_deleted": case(
            "one makes a function of steps of which another deletes one",
            {"call": step("call", *BODY, "A", function="f", args={}), "a": wait("f", "body", "A")},
            {BODY: ["call"], ("f", "body"): "a"},
            functions=["f"],
        ),
        "swapped_while_added": case(
            "one swaps the branches while another appends to then: that step stays in then",
            {
                "i": step("if", *BODY, "V"),
                "t": wait("i", "else", "V"),
                "e": wait("i", "then", "V"),
                "n": wait("i", "then", "W"),
            },
            {BODY: "i", ("i", "then"): "en", ("i", "else"): "t"},
        ),
        "taken_apart_while_filled": case(
            "one takes a frame apart while another puts a step into it: that step is kept as a draft",
            {"a": wait(*BODY, "A"), "b": wait(*BODY, "B"), "new": wait("frame", "body", "W")},
            {BODY: "ab"},
            ["new"],
        ),
    }


def cases() -> dict[str, dict[str, Any]]:
    """Return all cases by name."""
    groups = (_order(), _branches(), _places(), _functions(), _circles(), _kinds(), _depth(), _people())
    return {name: content for group in groups for name, content in group.items()}


def text_of(content: Mapping[str, Any]) -> str:
    """Return a case as it stands in its file."""
    return json.dumps(content, indent=1, ensure_ascii=True) + "\n"


def main() -> None:
    """Write the folder anew."""
    FOLDER.mkdir(exist_ok=True)
    for old in FOLDER.glob("*.json"):
        old.unlink()
    for name, content in cases().items():
        (FOLDER / f"{name}.json").write_text(text_of(content))


if __name__ == "__main__":
    main()
