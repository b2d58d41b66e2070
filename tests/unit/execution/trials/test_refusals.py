"""Every refusal of a test, of its YAML and of its faults is known by a code, and the screens have words for it."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator

import pytest

from execution.trials.refusals import SENTENCES, cause_of_refusal
from tests.kit.files import ROOT
from tests.unit.execution.test_reasons import sentence_of

READERS = ("execution/trials/trial_file.py", "execution/trials/trial_run.py", "execution/trials/yaml_lines.py",
           "simulation/fault_form.py")  # fmt: skip
RAISING = {"BadTrialFile", "BadFaults", "bad"}
NARROW = {"“{word}” is a text of at most {most} characters, not {value}."}


def refusals() -> Iterator[str]:
    """Give the sentences with which the readers refuse, with `7` for what they fill in."""
    for name in READERS:
        tree = ast.parse((ROOT / name).read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and getattr(node.func, "id", getattr(node.func, "attr", "")) in RAISING:
                yield from filter(lambda text: " " in text, map(sentence_of, node.args))
        if name.endswith("fault_form.py"):
            misfit = next(n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef) and n.name == "_misfit")
            yield from (t for n in ast.walk(misfit) if isinstance(n, ast.Return) for t in told_in(n))


def told_in(node: ast.Return) -> Iterator[str]:
    """Give the sentences that one line returns."""
    values = [node.value.body, node.value.orelse] if isinstance(node.value, ast.IfExp) else [node.value]
    yield from (text for value in values if value is not None and " " in (text := sentence_of(value)))


def whole(sentence: str) -> str:
    """Return a sentence with the end that is worked out elsewhere."""
    is_open = sentence.endswith(("” in the site. 7", "”. 7"))
    return f"{sentence[:-1]}There is none." if is_open else sentence


def test_every_refusal_of_a_test_has_a_code() -> None:
    found = [whole(text) for text in refusals()]
    assert len(found) > 45
    assert [text for text in found if cause_of_refusal(text.replace("no 7 “", "no zone “")) is None] == []


@pytest.mark.parametrize("code", SENTENCES)
def test_a_refusal_is_taken_apart_into_what_it_was_made_of(code: str) -> None:
    args = {name: f"some {name}" for name in re.findall(r"\{(\w+)\}", SENTENCES[code])}
    text = SENTENCES[code].format_map(args)
    assert cause_of_refusal(text) == {"code": code, "args": args}
    assert cause_of_refusal(f"Fault 12: {text}") == {"code": code, "args": {**args, "fault": "12"}}


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_screens_have_words_for_each_refusal_with_all_that_it_names(language: str) -> None:
    path = ROOT / "frontend" / "src" / "i18n" / language / "screens" / "refusal.json"
    words = json.loads(path.read_text(encoding="utf-8"))["bad_test"]
    assert words.keys() == SENTENCES.keys()
    for code, sentence in SENTENCES.items():
        assert set(re.findall(r"\{\{(\w+)\}\}", words[code])) == set(re.findall(r"\{(\w+)\}", sentence)), code


def test_other_words_are_no_refusal_of_ours() -> None:
    assert cause_of_refusal("The cat sat on the YAML.") is None
