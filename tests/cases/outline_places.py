"""Cases of what a document says by itself: order, branches, places and functions."""

from __future__ import annotations

from typing import Any

from tests.cases.outline_case import BODY, case, loop, step, wait


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


PLACES = {**_order(), **_branches(), **_places(), **_functions()}
"""All of them by name."""
