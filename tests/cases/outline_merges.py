"""Cases of what merges leave behind: circles, kinds that are not known, depth, and people who draw at once."""

from __future__ import annotations

from typing import Any

from tests.cases.outline_case import BODY, EVENTS, case, loop, step, wait


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
        "several_catches": case(
            "a Try has a catch for each list of kinds; where there is none, or no number of a catch, steps are drafts",
            {
                "t": step("try", *BODY, "A", kinds=["failed"], kinds2=[], kinds3=None, kinds8=["x"], kinds9=[]),
                "a": wait("t", "catch", "V"),
                "b": wait("t", "catch2", "V"),
                "c": wait("t", "catch3", "V"),
                "d": wait("t", "catch8", "V"),
                "e": wait("t", "catch9", "V"),
                "f": wait("t", "catch1", "V"),
            },
            {BODY: "t", ("t", "catch"): "a", ("t", "catch2"): "b", ("t", "catch8"): "d"},
            "cef",
        ),
        "first_catch_removed": case(
            "one person removes the first catch while another adds a second: the second stays, with its steps",
            {
                "t": step("try", *BODY, "A", catch=False, kinds=["failed"], kinds2=["offline"]),
                "a": wait("t", "catch", "V"),
                "b": wait("t", "catch2", "V"),
            },
            {BODY: "t", ("t", "catch2"): "b"},
            "a",
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


MERGES = {**_circles(), **_kinds(), **_depth(), **_people()}
"""All of them by name."""
