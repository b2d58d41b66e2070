"""Tests and kinds of odd numbers and types are refused with a sentence, never with a fault of ours."""

from pathlib import Path

import pytest

from execution.trials.trial_file import BadTrialFile, read_trial
from simulation.kind_file import BadKinds, default_kinds, read_kinds
from vipo_site.cli.main import main

HUGE = "1" + "0" * 400


@pytest.mark.parametrize(
    "said",
    [
        "when: {driver: [physics]}\nthen: [{ends: well}]",
        f"then: [{{within_s: {HUGE}}}]",
        "then: [{within_s: .nan}]",
        "then: [{within_s: .inf}]",
        f"given: {{readings: {{oven: {{heat: {HUGE}}}}}}}\nthen: [{{ends: well}}]",
        f"when: {{faults: [{{fault: battery, device: r1, percent: {HUGE}}}]}}\nthen: [{{ends: well}}]",
        f"when: {{faults: [{{fault: wrong_value, device: r1, property: a, value: {HUGE}}}]}}\nthen: [{{ends: well}}]",
        "when: {faults: [{fault: battery, device: r1, percent: .nan}]}\nthen: [{ends: well}]",
    ],
)
def test_a_test_with_an_odd_value_is_refused_with_a_sentence(said: str) -> None:
    with pytest.raises(BadTrialFile):
        read_trial(f"name: Odd\n{said}\n".encode())


def test_a_kind_with_a_number_beyond_all_measure_is_refused() -> None:
    with pytest.raises(BadKinds, match="must be a number of at most"):
        read_kinds(f'version = 1\n[[kinds]]\nname = "k"\njob_s = {HUGE}\n')


def test_own_kinds_that_cannot_be_read_are_told_without_a_fault_of_ours(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("VIPO_KINDS", "nowhere.toml")
    default_kinds.cache_clear()
    try:
        assert main(["rehearse", "examples/paint-order.json"]) == 2
    finally:
        default_kinds.cache_clear()
    assert "nowhere.toml, which cannot be read" in capsys.readouterr().err


def test_a_name_that_no_file_can_have_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "a\0b.py"]) == 2
    assert "cannot be read" in capsys.readouterr().err


def test_a_report_is_written_into_a_folder_that_is_made_and_tells_of_seeds(tmp_path: Path) -> None:
    report = tmp_path / "build" / "junit.xml"
    assert main(["test", "examples/tests/paint-order.yaml", "--junit", str(report)]) == 0
    assert 'failures="0"' in report.read_text()
