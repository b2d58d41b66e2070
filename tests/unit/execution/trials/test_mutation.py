"""Which ways through a program its tests take, and which changes of it they notice."""

import json
import re
from dataclasses import replace

import pytest

from editor.language import compile_document
from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import Call, End, Instruction, Plan
from execution.trials.coverage import Coverage, coverage_to_json, missed
from execution.trials.expectations import Verdict
from execution.trials.junit import junit_xml
from execution.trials.mutation import mutate
from execution.trials.odds import find_odds
from execution.trials.trial import Expectation, Trial
from execution.trials.trial_run import run_trial, settle
from execution.trials.yaml_lines import BadTrialFile
from simulation.world import Fault
from tests.kit import demo_floor
from tests.kit.demo_site import factory
from tests.kit.programs import document, step
from tests.unit.execution.trials.hot_box import BROKEN, NUMBERS, SUBJECT, WELL


def taken(outcome):
    return {way for way, count in outcome.coverage.taken.items() if count}


def test_ways_that_were_not_taken_are_named():
    outcome = run_trial(WELL, SUBJECT)
    never = missed(outcome.coverage.paths, outcome.coverage.taken)
    assert outcome.ok
    assert {(way.step, way.name) for way in never} == {
        ("try", "catch failed"), ("cool", "none"), ("cool", "one"), ("if", "false"), ("limit", "limit"),
    }  # fmt: skip
    assert ("cool", "many") in taken(outcome)


def test_a_fault_takes_the_way_of_the_catch():
    assert ("try", "catch failed") in taken(run_trial(BROKEN, SUBJECT))


def test_a_loop_of_a_fixed_number_of_rounds_has_one_way():
    ways = [way.name for way in run_trial(WELL, SUBJECT).coverage.paths if way.step == "repeat"]
    assert ways == ["reached", "many"]


def test_coverage_is_data_for_each_construct():
    outcome = run_trial(WELL, SUBJECT)
    told = {e["step"]: e for e in coverage_to_json(outcome.coverage.paths, outcome.coverage.taken, NUMBERS)}
    assert told["if"] == {"step": "if", "number": "3", "line": 5, "ways": {"reached": 1, "true": 1, "false": 0}}
    assert json.loads(json.dumps(told)) == told


def test_a_catch_that_is_taken_out_is_noticed_by_the_test_with_the_fault_alone():
    outcomes = [run_trial(trial, SUBJECT) for trial in (WELL, BROKEN)]
    seen = []
    found, there_are = mutate(SUBJECT, outcomes, 100, lambda number, of: seen.append((number, of)))
    by_change = {(each.mutant.step, each.mutant.what): each.noticed_by for each in found}
    assert by_change["try", "the catch is taken out"] == "The mixer fails"
    assert by_change["limit", "the time limit is taken out"] == ""
    assert by_change["cool", "the loop is taken out"] == ""
    assert (len(found), seen) == (there_are, [(n, there_are) for n in range(there_are)])


def test_of_many_changes_so_many_are_tried_as_asked_and_always_the_same():
    outcomes = [run_trial(WELL, SUBJECT)]
    tries = [mutate(SUBJECT, outcomes, 2, lambda number, of: None) for _ in range(2)]
    assert [(len(found), there_are) for found, there_are in tries] == [(2, 7), (2, 7)]
    assert tries[0] == tries[1]


def test_what_is_turned_in_a_step_that_no_test_reaches_is_not_tried():
    early = replace(WELL, then=(Expectation("fails", 1, "broke down"),), faults=BROKEN.faults)
    plan = replace(SUBJECT.plan, instructions=SUBJECT.plan.instructions[1:])
    subject = replace(
        SUBJECT, plan=replace(plan, instructions=(SUBJECT.plan.instructions[1], *SUBJECT.plan.instructions[1:]))
    )
    outcome = run_trial(early, subject)
    found, _ = mutate(subject, [outcome], 100, lambda number, of: None)
    assert outcome.ok
    assert {each.is_reached for each in found} == {False}


@pytest.mark.parametrize(
    ("trial", "line", "why"),
    [
        (replace(WELL, faults=(Fault("paintMixer02", "dead", step="9"),), faults_line=8), 8, "no step “9”"),
        (replace(WELL, faults=(Fault("nobody", "dead"),), faults_line=8), 8, "there is no device 'nobody'"),
        (replace(WELL, parameters={"x": 1}), 1, "The program has no parameter “x”. There is none."),
        (replace(WELL, stocks={"nobody": {}}), 1, "There is no device “nobody”"),
        (replace(WELL, readings={"paintMixer02": {"colour": 1}}), 1, "paintMixer02 has no property “colour”."),
        (Trial("a", 1, (Expectation("step", 4, {"step": "9"}),)), 4, "The program has no step “9”."),
        (Trial("a", 1, (Expectation("item", 4, {"object": "box", "at": "moon"}),)), 4, "no device “moon”"),
        (Trial("a", 1, (Expectation("never_two_in", 4, {"zone": "moon"}),)), 4, "There is no zone “moon”."),
    ],
)  # fmt: skip
def test_what_the_program_or_the_site_does_not_have_is_refused_with_its_line(trial, line, why):
    with pytest.raises(BadTrialFile) as refused:
        settle(trial, SUBJECT)
    assert why in refused.value.why
    assert refused.value.line == line


def test_steps_are_found_by_their_number():
    trial = settle(
        Trial("a", 1, (Expectation("step", 4, {"step": "1a"}),), faults=(Fault("paintMixer02", "dead", step="2"),)),
        SUBJECT,
    )
    assert (trial.then[0].says, trial.faults[0].step) == ({"step": "mix"}, "cool")


def test_junit_says_what_was_expected_and_seen_and_is_xml_whatever_it_says():
    outcome = replace(run_trial(WELL, SUBJECT), verdicts=(Verdict("a <b> & “c”", 4, ok=False, saw='\x00\x1b"]]>'),))
    text = junit_xml([("tests/a.yaml", [outcome, run_trial(WELL, SUBJECT)])], {})
    assert 'tests="2" failures="1" errors="0"' in text
    assert "expected: a &lt;b&gt; &amp; “c”; seen: \ufffd\ufffd" in text
    assert not {"\x00", "\x1b"} & set(text)


def test_a_test_that_fails_with_some_seeds_fails_in_junit_too():
    outcome = run_trial(WELL, SUBJECT)
    odds = {("tests/a.yaml", outcome.trial.name): find_odds([1.0] * 70, 30)}
    text = junit_xml([("tests/a.yaml", [outcome])], odds)
    assert 'tests="1" failures="1" errors="0"' in text
    assert "with 30 of 100 seeds it fails, 30.0 %" in text
    assert 'failures="0"' in junit_xml([("tests/b.yaml", [outcome])], odds)


@pytest.mark.parametrize(("items", "rounds"), [(["red"], "one"), (["red", "white"], "many")])
def test_a_for_each_over_a_list_that_is_written_down_is_asked_for_its_own_rounds_alone(items, rounds):
    drawn = document(
        {
            "a": step("for_each", variable="x", items=items),
            "b": step("notify", ("a", "body"), message="one more", level="info"),
        }
    )
    plan = compile_document(drawn, factory()).plan
    assert {path.name for path in Coverage(plan).paths if path.step == "a"} == {"reached", rounds}


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"stocks": {"robot01": {"box": 2}}}, "robot01 is a robot; write what it holds under “carrying”."),
        ({"carrying": {"paintMixer02": {"box": 2}}}, "paintMixer02 is a machine; write what it holds under “stock”."),
        ({"readings": {"paintMixer02": {"temperature": "hot"}}},
         "The reading temperature of paintMixer02 is a number; 'hot' is none."),
        ({"readings": {"paintMixer02": {"temperature": True}}},
         "The reading temperature of paintMixer02 is a number; True is none."),
        ({"then": (Expectation("commands", 7, ["paintMixer2.mixPaint"]),)}, "There is no device “paintMixer2”"),
    ],
)  # fmt: skip
def test_what_is_given_or_expected_of_devices_has_to_suit_them(given, why):
    with pytest.raises(BadTrialFile, match=re.escape(why)):
        settle(replace(WELL, **given), SUBJECT)
    assert settle(replace(WELL, then=(Expectation("commands", 7, ["paintMixer02.mixPaint", "drop"]),)), SUBJECT)


def test_commands_of_devices_whose_ids_begin_with_their_site_are_found():
    elsewhere = replace(next(d for d in demo_floor.devices() if d.id == "paintMixer02"), id="hall.mixer01")
    call = Instruction(Call(PlaceRef(device="hall.mixer01"), "mixPaint", {"time": Constant(1)}), "mix", 1)
    scene = replace(SUBJECT.scene, devices=(elsewhere,))
    subject = replace(SUBJECT, plan=Plan((call, Instruction(End()))), scene=scene, numbers={}, lines=())
    for named in ("hall.mixer01.mixPaint", "mixPaint"):
        trial = settle(Trial("a", 1, (Expectation("commands", 7, [named]),)), subject)
        assert [verdict.saw for verdict in run_trial(trial, subject).verdicts] == ["they came"]
    for named, device in (("mixer01.mixPaint", "mixer01"), ("hall.mixPaint", "hall")):
        with pytest.raises(BadTrialFile, match=f"There is no device “{device}” in the site. There are: hall.mixer01."):
            settle(Trial("a", 1, (Expectation("commands", 7, [named]),)), subject)
