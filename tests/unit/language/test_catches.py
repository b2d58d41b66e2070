"""Several catches of one Try: document, tree, script and drawing say the same, and an edit keeps all others."""

import pytest

from editor.language import compile_document, parse_script, tree_to_document
from editor.language.document.catches import KINDS_OF, MOST_CATCHES, branches_for, catches_of
from editor.language.document.format_migrations import FORMAT
from editor.language.reading.document import read_document
from editor.language.tree.nodes import Catch, Notify, Try
from editor.language.tree.numbering import number_steps
from tests.kit.demo_site import factory
from tests.kit.programs import document, step

SITE = factory()


def several(**params):
    """Return a document of a Try with these catches, each with a message."""
    steps = {"t": step("try", **params), "b": step("wait", ("t", "body"), duration=5)}
    for branch in catches_of(params):
        steps[branch] = step("notify", ("t", branch), message=branch, level="info")
    return document({**steps, "z": step("notify", ("t", "finally"), message="over", level="info")})


def redrawn(before, change=lambda script: script):
    """Return the document that its script, changed, is drawn as."""
    compiled = compile_document(before, SITE)
    parsed = parse_script(change(compiled.script), SITE)
    assert parsed.tree is not None, parsed.diagnostics
    return tree_to_document(parsed.tree, SITE, before)


def params_of(drawn):
    return drawn["steps"]["t"]["params"]


def where(drawn):
    return {name: tuple(each["place"][:2]) for name, each in drawn["steps"].items() if each["place"]}


CATCHES = [
    {},
    {"catch": False},
    {"kinds": ["failed"], "kinds2": []},
    {"kinds": ["failed"], "kinds3": ["offline", "blocked"], "kinds8": []},
    {"catch": False, "kinds": ["failed"], "kinds4": ["offline"]},
    {"kinds": ["failed"]} | {f"kinds{number}": ["offline"] for number in range(2, 9)},
]


@pytest.mark.parametrize("params", CATCHES)
def test_the_script_reads_back_and_draws_nothing_anew(params):
    before = several(**params)
    tree = compile_document(before, SITE).tree
    assert [len(node.handlers) for node in tree.body if isinstance(node, Try)] == [len(catches_of(params))]
    after = redrawn(before)
    assert {name: value for name, value in params_of(after).items() if params or name != "kinds"} == params
    assert where(after) == where(before)


def test_the_script_has_an_except_for_each():
    script = compile_document(several(kinds=["offline"], kinds2=["failed", "blocked"], kinds3=[]), SITE).script
    assert [line.strip() for line in script.splitlines() if "except" in line] == [
        "except Offline as problem:",
        "except (Failed, Blocked) as problem:",
        "except TaskError as problem:",
    ]


def test_an_old_document_has_its_one_catch():
    tree = read_document(several(kinds=["failed"])).tree
    (node,) = tree.body
    assert isinstance(node, Try)
    assert [(catch.kinds, catch.branch) for catch in node.handlers] == [(("failed",), "catch")]
    assert FORMAT == 2


def test_kinds_that_are_changed_in_the_script_change_that_catch_alone():
    before = several(kinds=["offline"], kinds3=["failed"], kinds5=[])
    after = redrawn(before, lambda script: script.replace("except Failed", "except (Failed, Blocked)"))
    assert params_of(after) == {"kinds": ["offline"], "kinds3": ["failed", "blocked"], "kinds5": []}
    assert where(after) == where(before)


def test_an_except_that_is_added_in_the_script_gets_the_next_number():
    before = several(kinds=["offline"], kinds3=["failed"])
    added = '        except Blocked as problem:\n            self.notify("new", level="info")\n        finally:'
    after = redrawn(before, lambda script: script.replace("        finally:", added))
    assert params_of(after) == {"kinds": ["offline"], "kinds3": ["failed"], "kinds4": ["blocked"]}
    assert where(before).items() <= where(after).items()
    assert sorted(where(after).keys() - where(before).keys()) == ["s1"]


def test_an_except_that_is_taken_out_of_the_script_is_gone():
    gone = '        except Failed as problem:\n            self.notify("catch3", level="info")\n'
    after = redrawn(several(kinds=["offline"], kinds3=["failed"]), lambda script: script.replace(gone, ""))
    assert params_of(after) == {"kinds": ["offline"]}
    assert where(after)["catch"] == ("t", "catch")


def test_steps_of_each_catch_have_letters_of_their_own_and_the_finally_comes_last():
    params = {f"kinds{number}": ["failed"] for number in range(2, 9)}
    tree = read_document(several(kinds=["offline"], **params)).tree
    numbers = number_steps(tree).numbers
    assert [numbers[branch] for branch in KINDS_OF] == ["1c", "1d", "1e", "1g", "1h", "1i", "1j", "1k"]
    assert numbers["z"] == "1f"


def test_in_a_program_with_functions_the_finally_is_read_behind_all_catches():
    body = several(kinds=["offline"], **{f"kinds{number}": ["failed"] for number in range(2, 9)})
    body["functions"] = {"f": {"name": "rest", "parameters": []}}
    body["steps"]["b"] = step("call", ("t", "body"), function="f", args={})
    body["steps"]["w"] = {**step("wait", duration=5), "place": ["f", "body", "1V"]}
    numbers = number_steps(read_document(body).tree).numbers
    assert list(numbers) == ["t", "b", "w", *KINDS_OF, "z"]


def test_a_catch_that_cannot_be_reached_and_a_kind_in_two_are_told_at_their_fields():
    def told(**params):
        found = compile_document(several(**params), SITE).diagnostics
        return [(each.code, each.field) for each in found]

    assert told(kinds=["failed"], kinds2=["offline"], kinds3=[]) == []
    assert told(kinds=[], kinds5=["offline"]) == [("catch_never_reached", "kinds5")]
    assert told(kinds=["failed"], kinds2=["failed", "offline"]) == [("caught_before", "kinds2")]
    assert told(kinds=["failed"], kinds2=["offline"], kinds3=["offline", "failed"]) == [
        ("catch_never_reached", "kinds3")
    ]
    every = ["refused", "failed", "timed_out", "offline", "blocked", "cancelled"]
    assert told(kinds=every, kinds2=[]) == [("catch_never_reached", "kinds2")]


def test_numbers_for_more_and_fewer_catches_than_there_were():
    assert branches_for((), 2) == ("catch", "catch2")
    assert branches_for(("catch2", "catch5"), 1) == ("catch2",)
    assert branches_for(("catch2", "catch5"), 3) == ("catch2", "catch5", "catch6")
    assert branches_for(("catch", "catch8"), 3) == ("catch", "catch2", "catch3")
    assert len(branches_for((), MOST_CATCHES)) == MOST_CATCHES


def test_the_branch_of_a_catch_takes_no_part_in_a_comparison():
    block = (Notify("Wet."),)
    assert Catch(("failed",), block, "catch") == Catch(("failed",), block, "catch5")
    assert Catch().takes("offline")
    assert not Catch(("failed",)).takes("offline")
