"""Right programs of the field, in `tests/cases/right/<site>/`: nothing is told of them, and they print as they are.

Each file is a script whose first line says what the work is. `KNOWN_FALSE` lists what is told all the same.
"""

from __future__ import annotations

import random
import re
from pathlib import Path
from typing import Any

import pytest

from editor.language import Compiled, Surroundings, Tree, compile_document, parse_script, tree_to_document
from tests.kit.demo_site import factory
from tests.unit.language.checks.field_sites import hospital, warehouse
from tests.unit.language.checks.field_trial import Trial

RIGHT = Path(__file__).resolve().parents[3] / "cases" / "right"
SITES = {"factory": factory, "hospital": hospital, "warehouse": warehouse}
FILES = sorted(RIGHT.glob("*/*.txt"))
LEAST = 200
RUNS = 12
CORNER = {
    "name": "Busy corner",
    "rule": "one_at_a_time",
    "points": [[2.4, -13.6], [4.8, -13.6], [4.8, -12], [2.4, -12]],
}
SAME_CONDITION = "A condition that is asked twice is not known to have the same answer."
KNOWN_FALSE: dict[str, tuple[list[str], str]] = {
    "factory/only-if-good-carry": (["may_drop_nothing"], SAME_CONDITION),
    "hospital/asked-only-if-needed": (["may_be_unset"], SAME_CONDITION),
    "hospital/found-flag": (["may_be_unset"], SAME_CONDITION),
    "hospital/gather-if-any": (["may_drop_nothing"], "That a variable counts what is carried is not known."),
}
"""Programs that are right and of which something is told: the codes, and why they are told.

All four are warnings, and a run goes on. To know that a condition has the same outcome again, what holds after either
outcome would have to be kept apart all along the path behind the first If, and every step there followed once for each
of them: twice as many with each such condition, in loops and calls, too, while the steps followed are bounded. To know
that `held` counts what is carried, a domain would have to relate variables to loads; a range for each of the two does
not say that they are equal. Both cost more than they would spare.
"""


def name_of(file: Path) -> str:
    return f"{file.parent.name}/{file.stem}"


def parsed(text: str, site: Surroundings) -> Tree:
    found = parse_script(text, site)
    assert found.tree is not None, [each.message for each in found.diagnostics]
    return found.tree


def compiled(tree: Tree, site: Surroundings, text: str) -> Compiled:
    """Compile what is drawn for a script, on a map with the zones of which it speaks."""
    document: dict[str, Any] = tree_to_document(tree, site)
    document["zones"] = {
        **document.get("zones", {}),
        **dict.fromkeys(re.findall(r'ctx\.zone\("(\w+)"\)', text), CORNER),
    }
    return compile_document(document, site)


@pytest.mark.parametrize("file", FILES, ids=name_of)
def test_nothing_is_told_of_a_program_of_the_field(file: Path) -> None:
    text, site = file.read_text(), SITES[file.parent.name]()
    tree = parsed(text, site)
    found = compiled(tree, site, text)
    codes = [each.code for each in found.diagnostics]
    assert codes == KNOWN_FALSE.get(name_of(file), ([], ""))[0], [(e.step, e.message) for e in found.diagnostics]
    again = parsed(found.script, site)
    assert again == found.tree
    assert compiled(again, site, text).script == found.script
    assert (found.plan is None) == any(each.severity == "error" for each in found.diagnostics)


def test_there_are_many_different_ones_and_each_says_what_it_is_for() -> None:
    texts = [file.read_text() for file in FILES]
    assert all(re.match(r"# [A-Z].*\.\n", text) for text in texts)
    assert len({text.partition("\n")[0] for text in texts}) == len(texts)
    assert len({text.partition("\n")[2] for text in texts}) == len(texts) >= LEAST


def test_what_is_told_falsely_is_told_of_a_program_that_is_there() -> None:
    assert set(KNOWN_FALSE) <= {name_of(file) for file in FILES}
    assert all(codes and why.endswith(".") for codes, why in KNOWN_FALSE.values())


@pytest.mark.parametrize("file", FILES, ids=name_of)
def test_a_program_of_the_field_does_what_can_be_done_and_comes_to_its_end(file: Path) -> None:
    text, site = file.read_text(), SITES[file.parent.name]()
    plan = compiled(parsed(text, site), site, text).plan
    assert plan is not None
    trials = [Trial(plan, site, random.Random(seed), failing=0.2 * (seed % 2)) for seed in range(RUNS)]
    ends = [trial.run() for trial in trials]
    assert [trial.wrong for trial in trials if trial.wrong] == []
    assert "finished" in {status for status, _ in ends}
    reasons = {
        reason for (status, reason), trial in zip(ends, trials, strict=True) if status == "failed" and not trial.failed
    }
    assert all(_is_meant(reason, text) for reason in reasons), reasons


def _is_meant(reason: str, text: str) -> bool:
    """Tell whether a run may fail for this reason: the program says so, or it has given something a time."""
    return "raise Failed" in text or (("timeout=" in text or "self.limit" in text) and bool(reason))


def test_a_trial_tells_of_what_a_right_program_does_not() -> None:
    text = (RIGHT / "factory" / "two-boxes-at-once.txt").read_text().replace('drop({"value": 2', 'drop({"value": 1')
    found = compiled(parsed(text, factory()), factory(), text)
    assert [each.code for each in found.diagnostics] == ["ends_carrying"]
    assert found.plan is not None
    trial = Trial(found.plan, factory(), random.Random(1))
    assert trial.run()[0] == "finished"
    assert [each.partition(" ")[2] for each in trial.wrong] == ["ends with {'box': 1}"]
