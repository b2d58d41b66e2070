"""A file of tests is taken apart into texts that are tests, and put together of them again."""

from __future__ import annotations

import pytest

from execution.trials.trial_file import read_trial, read_trials
from execution.trials.trial_texts import put_together, take_apart
from execution.trials.yaml_lines import BadTrialFile
from tests.kit.files import ROOT

FILES = sorted((ROOT / "examples" / "tests").glob("*.yaml"))


def told(trial):
    return trial.name, trial.seed, trial.faults, trial.stocks, [(each.kind, each.says) for each in trial.then]


@pytest.mark.parametrize("path", FILES, ids=[path.stem for path in FILES])
def test_taken_apart_and_put_together_a_file_says_the_same(path):
    payload = path.read_bytes()
    texts = take_apart(payload)
    before = [told(trial) for trial in read_trials(payload).trials]
    assert [told(read_trial(text.encode())) for text in texts] == before
    assert [told(trial) for trial in read_trials(put_together("a.json", texts).encode()).trials] == before


def test_comments_and_blocks_of_text_stay_as_they_are():
    text = "# Why this one.\nname: A\n\nwhen: {seed: 1}  # chance\nthen:\n- fails: |-\n    two\n    lines\n"
    file = put_together("b.json", [text])
    assert "  # Why this one.\n  - name: A\n\n    when: {seed: 1}  # chance\n" in file
    [again] = take_apart(file.encode())
    assert again == text.removeprefix("# Why this one.\n")
    assert read_trial(again.encode()).then[0].says == "two\nlines"


def test_the_name_of_a_program_is_quoted_where_yaml_needs_it():
    file = put_together("what: now.json", ["name: A\nthen: [ends: well]\n"])
    assert read_trials(file.encode()).program == "what: now.json"


@pytest.mark.parametrize(
    "payload", [b"", b"tests: []", b"version: 1\nprogram: a\ntests: {}", b"\xff\xfe\x00", b"a: &x [*x]"]
)
def test_what_is_no_file_of_tests_is_not_taken_apart(payload):
    with pytest.raises(BadTrialFile):
        take_apart(payload)
