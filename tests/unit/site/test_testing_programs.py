"""`vipo test`: the examples' own tests, exit codes, and what is said."""

import json
import xml.etree.ElementTree as ElementTree

import pytest

from tests.kit.files import ROOT
from vipo_site.cli.main import main

EXAMPLES = ROOT / "examples" / "tests"
RETRY = EXAMPLES / "retry-then-call.yaml"


def written(tmp_path, then, **more):
    program = more.get("program", ROOT / "examples" / "retry-then-call.json")
    path = tmp_path / "a.yaml"
    path.write_text(f"version: 1\nprogram: {program}\ntests:\n  - name: Delivered\n    then:\n      - {then}\n")
    return str(path)


def test_the_examples_pass_their_own_tests_and_junit_tells_of_it(tmp_path, capsys):
    junit = tmp_path / "junit.xml"
    assert main(["test", str(EXAMPLES), "--junit", str(junit)]) == 0
    said = capsys.readouterr().out
    suites = ElementTree.parse(junit).getroot()
    cases = [case.get("name") for suite in suites for case in suite]
    assert "The mixer fails once and is tried again" in cases
    assert all(f"passed  {name}" in said for name in cases)
    assert 'step 4c.3a, self.notify("The mixer still waits for somebody", level="warning"): never reached' in said


def test_a_test_that_fails_says_what_was_expected_and_seen_with_its_line(tmp_path, capsys):
    assert main(["test", written(tmp_path, "within_s: 10")]) == 1
    said = capsys.readouterr().out
    assert "FAILED  Delivered (" in said
    assert "line 6: expected: ends within 10 s" in said
    assert "seen:     it took " in said
    assert said.splitlines()[-1] == "retry-then-call.json: 0 of 1 tests pass."


def test_json_has_expectations_coverage_odds_and_what_no_test_notices(tmp_path, capsys):
    asked = ["test", written(tmp_path, "ends: well"), "--json", "--seeds", "2", "--mutate", "--mutants", "2"]
    assert main(asked) == 0
    (program,) = json.loads(capsys.readouterr().out)["programs"]
    (test,) = program["files"][0]["tests"]
    assert (test["ok"], test["odds"]["seeds"], test["odds"]["failed"]) == (True, 2, 0)
    assert test["expectations"][0]["expected"] == "ends well"
    assert [e["ways"]["many"] for e in program["coverage"] if "many" in e["ways"]] == [0]
    assert len(program["mutations"]) == 2
    assert program["mutants"] > 2


def test_what_no_test_notices_is_not_asked_of_tests_that_fail(tmp_path, capsys):
    assert main(["test", written(tmp_path, "within_s: 10"), "--mutate"]) == 1
    assert "Tests that fail notice everything" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("then", "why"),
    [
        ("ends: soon", "a.yaml: line 6: Write “ends: well”"),
        ("step: {step: 99}", "a.yaml: line 6: The program has no step “99”. There are: 1,"),
    ],
)
def test_a_file_that_cannot_be_used_is_refused_with_its_line(tmp_path, capsys, then, why):
    assert main(["test", written(tmp_path, then)]) == 2
    assert why in capsys.readouterr().err


def test_a_folder_without_tests_and_a_program_that_is_not_there_are_told_of(tmp_path, capsys):
    assert main(["test", str(tmp_path)]) == 2
    assert "holds no file of tests (.yaml)" in capsys.readouterr().err
    assert main(["test", written(tmp_path, "ends: well", program="gone.json")]) == 2
    assert "gone.json cannot be read" in capsys.readouterr().err
    assert main(["test", str(RETRY), "--seeds", "5000"]) == 2
