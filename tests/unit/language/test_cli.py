from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.kit.files import ROOT
from vipo_site.cli.main import main

EXAMPLES = ROOT / "examples"
SITE = str(EXAMPLES / "painting-factory.json")


@pytest.mark.parametrize("name", ["pick-and-drop", "paint-order"])
def test_the_examples_are_clean(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(EXAMPLES / f"{name}.json")]) == 0
    assert capsys.readouterr().out.endswith("0 errors, 0 warnings.\n")


def test_a_script_that_was_written_out_prints_the_same_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["script", str(EXAMPLES / "paint-order.json")]) == 0
    text = capsys.readouterr().out
    path = tmp_path / "order.py"
    path.write_text(text)
    assert main(["script", str(path), "--site", SITE]) == 0
    assert capsys.readouterr().out == text


def test_a_script_is_drawn_into_a_program_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script, drawn = tmp_path / "order.py", tmp_path / "order.json"
    assert main(["script", str(EXAMPLES / "paint-order.json")]) == 0
    text = capsys.readouterr().out
    script.write_text(text)
    assert main(["draw", str(script), "--site", SITE, "-o", str(drawn)]) == 0
    assert capsys.readouterr().out == ""
    assert (json.loads(drawn.read_text())["vipo"], json.loads(drawn.read_text())["name"]) == (1, "order")
    assert main(["script", str(drawn)]) == 0
    assert capsys.readouterr().out == text


def test_a_script_drawn_over_its_program_changes_only_what_it_says(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program, script = EXAMPLES / "paint-order.json", tmp_path / "order.py"
    assert main(["script", str(program)]) == 0
    script.write_text(capsys.readouterr().out)
    assert main(["draw", str(script), "--site", SITE, "--over", str(program)]) == 0
    drawn, before = json.loads(capsys.readouterr().out), json.loads(program.read_text())
    assert drawn["document"] == before["document"]
    assert main(["draw", str(script), "--site", SITE, "--json"]) == 0
    body = json.loads(capsys.readouterr().out)
    assert body["script"] == script.read_text()
    assert body["document"]["steps"].keys() == set(body["order"])


def test_a_faulty_script_is_not_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script, drawn = tmp_path / "bad.py", tmp_path / "bad.json"
    script.write_text("import os\n")
    assert main(["draw", str(script), "--site", SITE, "-o", str(drawn)]) == 1
    assert "bad.py: Line 1, column 1: " in capsys.readouterr().err
    assert not drawn.exists()
    assert main(["draw", str(EXAMPLES / "paint-order.json"), "-o", str(tmp_path / "no" / "x.json")]) == 2
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.parametrize("command", ["check", "plan", "script"])
def test_every_command_takes_a_script(command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "order.py"
    assert main(["script", str(EXAMPLES / "paint-order.json")]) == 0
    path.write_text(capsys.readouterr().out)
    assert main([command, str(path), "--site", SITE]) == 0
    from_script = capsys.readouterr().out
    assert main([command, str(EXAMPLES / "paint-order.json")]) == 0
    from_script = from_script.replace("order:", "Paint order:").replace('"mix_paint"', '"mixPaint"')
    assert from_script == capsys.readouterr().out


def test_the_plan_is_json_for_machines(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", str(EXAMPLES / "pick-and-drop.json"), "--json"]) == 0
    plan = json.loads(capsys.readouterr().out)
    assert [instruction["do"] for instruction in plan["instructions"]] == [
        "Move",
        "Call",
        "Pick",
        "Move",
        "Drop",
        "End",
    ]


def test_errors_in_a_program_give_code_1(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "program.json"
    path.write_text(json.dumps({"vipo": 1, "name": "Nothing", "document": {}, "site": {"devices": []}}))
    assert main(["check", str(path)]) == 1
    assert capsys.readouterr().out == (
        "error: program: This program has no steps yet. Draw a Pick-and-Drop to begin. [empty_program]\n"
        "Nothing: 1 error, 0 warnings.\n"
    )
    assert main(["plan", str(path)]) == 1
    assert main(["rehearse", str(path)]) == 1


def test_the_checks_speak_german_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "program.json"
    path.write_text(json.dumps({"vipo": 1, "name": "Nichts", "document": {}, "site": {"devices": []}}))
    assert main(["check", str(path), "--lang", "de"]) == 1
    assert capsys.readouterr().out == (
        "Fehler: Programm: Dieses Programm hat noch keine Schritte. Beginnen Sie mit Holen und Bringen. "
        "[empty_program]\nNichts: 1 Fehler, 0 Hinweise.\n"
    )
    script = tmp_path / "bad.py"
    script.write_text("import os\n")
    assert main(["script", str(script), "--site", SITE, "--lang", "de"]) == 1
    assert "Zeile 1, Spalte 1: " in capsys.readouterr().err


def test_a_script_outside_the_language_gives_code_1(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "bad.py"
    path.write_text("import os\n")
    assert main(["check", str(path), "--site", SITE, "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["diagnostics"][0]["code"] == "not_in_language"


def test_no_more_is_read_than_a_program_may_have(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "/dev/zero"]) == 2
    assert capsys.readouterr().err == "/dev/zero is larger than 20 MB. That is no program.\n"


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("{", "is not JSON: line 1"),
        ("[" * 100_000, "is not JSON that can be read"),
        ("[]", "must hold a JSON object"),
        ("{}", "is no program file"),
        ('{"steps": {}}', "names no site"),
        ('{"vipo": 1, "document": {}, "site": 5}', "must be a JSON object"),
        ('{"vipo": 1, "document": {}, "site": "gone.json"}', "gone.json cannot be read"),
        ('{"vipo": 1, "document": {}, "site": {"devices": [{"id": "x"}]}}', "device x cannot be read"),
        ('{"vipo": 1, "document": {}, "site": {"places": [{"id": "x"}]}}', "Place x needs"),
        ('{"vipo": 1, "document": {}, "site": {"grid": {"yaml": "gone.yaml"}}}', "gone.yaml cannot be read"),
    ],
)
def test_a_bad_file_gives_code_2_and_one_sentence(
    text: str, sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "bad.json"
    path.write_text(text)
    assert main(["check", str(path)]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert sentence in said.err
    assert said.err.count("\n") == 1


def test_bad_usage_gives_code_2_and_one_sentence(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["paint", "x.json"])
    assert stop.value.code == 2
    assert capsys.readouterr().err.count("\n") == 1
