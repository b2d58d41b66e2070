"""Commands that have no answer: who reads standard output as JSON finds why there; exit codes are as they are told."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.kit.command_line import run_vipo
from tests.kit.files import ROOT

SITE = str(ROOT / "examples" / "painting-factory.json")
PROGRAM = str(ROOT / "examples" / "pick-and-drop.json")
MAP = str(ROOT / "registry" / "demo" / "painting-factory.yaml")
TESTS = "version: 1\nprogram: {}\nsite: {}\ntests:\n  - name: a\n    then: [{{ends: well}}]\n"


@pytest.mark.parametrize(
    ("arguments", "code", "detail"),
    [
        (("rehearse", "gone.json"), "unreadable_file", "gone.json cannot be read: No such file or directory."),
        (("test", "gone.yaml"), "unreadable_file", "gone.yaml cannot be read: No such file or directory."),
        (("scan", "--map", "gone.yaml", "--out", "x"), "unreadable_file",
         "gone.yaml cannot be read: No such file or directory."),
        (("scan", "--map", MAP, "--out", "x", "--lidar", "1"), "bad_option",
         "--lidar 1 is out of bounds; choose 2 to 40 metres."),
        (("rehearse", PROGRAM, "--seed", "-1"), "bad_option", "--seed must be a whole number from 0 to 2147483647."),
        (("rehearse", PROGRAM, "--seed", "2147483648"), "bad_option",
         "--seed must be a whole number from 0 to 2147483647."),
        (("test", "a.yaml", "--seeds", "-1"), "bad_option",
         "--seeds takes a number from 0 to 1000, --mutants one from 1 to 1000."),
        (("describe", "gone.ttl"), "unreadable_file", "gone.ttl cannot be read: No such file or directory."),
        (("history", "gone.gz"), "unreadable_file", "There is no file gone.gz."),
        (("scan", "--map", MAP, "--out", "/dev/null/x"), "not_possible",
         "This cannot be done: Not a directory: /dev/null/x."),
    ],
)  # fmt: skip
def test_what_cannot_be_done_is_json_for_machines_and_a_sentence_for_people(
    arguments: tuple[str, ...], code: str, detail: str, capsys: pytest.CaptureFixture[str]
) -> None:
    ended, out, err = run_vipo(capsys, *arguments, "--json")
    assert (ended, json.loads(out), err) == (2, {"code": code, "detail": detail}, f"{detail}\n")
    assert run_vipo(capsys, *arguments) == (2, "", f"{detail}\n")


def test_bad_usage_is_json_too(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        run_vipo(capsys, "rehearse", "a.json", "--seed", "some", "--json")
    out, err = capsys.readouterr()
    assert stop.value.code == 2
    assert (json.loads(out)["code"], json.loads(out)["detail"] + "\n") == ("bad_usage", err)


@pytest.mark.parametrize("command", ["rehearse", "plan"])
def test_a_program_with_errors_has_them_in_json(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "program.json"
    path.write_text(json.dumps({"vipo": 1, "name": "Nothing", "document": {}, "site": {"devices": []}}))
    code, out, err = run_vipo(capsys, command, str(path), "--json")
    told = json.loads(out)
    assert (code, told["code"]) == (1, "not_ready")
    assert told["detail"] == f"Nothing has 1 error and cannot be carried out. Try: vipo check {path}"
    assert [diagnostic["code"] for diagnostic in told["diagnostics"]] == ["empty_program"]
    assert err.startswith("error: program: This program has no steps yet.")


def test_a_script_outside_the_language_is_no_test_that_failed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script, tests = tmp_path / "bad.py", tmp_path / "a.yaml"
    script.write_text("import os\n")
    tests.write_text(TESTS.format("bad.py", SITE))
    code, out, err = run_vipo(capsys, "test", str(tests), "--json")
    assert (code, json.loads(out)["code"]) == (2, "bad_script")
    assert f"{script}: Line 1, column 1: " in err
    code, out, err = run_vipo(capsys, "rehearse", str(script), "--site", SITE, "--json")
    assert (code, json.loads(out)["code"], len(json.loads(out)["diagnostics"])) == (1, "bad_script", 1)
    assert f"{script}: Line 1, column 1: " in err


def test_a_program_with_errors_is_no_test_that_failed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "empty.json").write_text('{"steps": {}}')
    (tmp_path / "a.yaml").write_text(TESTS.format("empty.json", SITE))
    code, out, err = run_vipo(capsys, "test", str(tmp_path), "--json")
    assert (code, json.loads(out)["code"], json.loads(out)["detail"] + "\n") == (2, "not_ready", err)
    assert "has errors, so it cannot be tested." in err
