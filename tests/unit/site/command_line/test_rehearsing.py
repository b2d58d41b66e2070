"""`vipo rehearse`: steps are told as people find them, by number and line, and as programs do, by id."""

from __future__ import annotations

import json

import pytest

from tests.kit.command_line import run_vipo
from tests.kit.files import ROOT

PROGRAM = str(ROOT / "examples" / "cure-until-cool.json")
WAITS = 'self.wait(until=self.curing_oven.temperature <= 30 or self.looks >= 30, timeout=quantity(1, "min"))'


def test_what_went_wrong_is_told_with_the_steps_number_and_line(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run_vipo(capsys, "rehearse", PROGRAM, "--driver", "kinematic")
    assert (code, err) == (0, "")
    wrong = [line for line in out.splitlines() if line.startswith("error")]
    assert wrong[0] == f"error: at 272 s, step 4aa, line 11, {WAITS}: The condition did not come true in time."
    _, script, _ = run_vipo(capsys, "script", PROGRAM)
    assert script.splitlines()[10].strip() == WAITS


def test_json_has_the_steps_words_beside_their_ids(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run_vipo(capsys, "rehearse", PROGRAM, "--driver", "kinematic", "--json")
    result = json.loads(out)
    assert (code, err, len(result["errors"])) == (0, "", 3)
    names = ("step", "number", "line", "words")
    assert [result["errors"][0][name] for name in names] == ["s8", "4aa", 11, WAITS]
    of_step = {entry["step"]: entry["number"] for entry in result["steps"]}
    assert of_step["s8"] == "4aa"
    assert "" not in of_step.values()
    assert {tuple(entry[name] for name in names) for entry in result["log"] if not entry["step"]} == {("", "", 0, "")}
    assert all(entry["words"] for entry in result["log"] if entry["step"])
