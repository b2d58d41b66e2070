"""Files of tests: what is read, and the line and sentence with which anything else is refused."""

import pytest

from execution.trials.trial import Expectation
from execution.trials.trial_file import read_trials
from execution.trials.yaml_lines import BadTrialFile
from simulation.world import Fault

HEAD = "version: 1\nprogram: a.json\ntests:\n"
WHOLE = """version: 1
program: ../a.json
site: hall.json
tests:
  - name: All of it
    given:
      stock: {shelf: {box: 3}}
      carrying: {robot: {can: 1}}
      readings: {oven: {temperature: 22, door: closed}}
    when:
      seed: 7
      driver: physics
      limit_s: 60
      parameters: {minutes: 3}
      faults:
        - {fault: fails, device: oven, at_step: 3, nth: 2}
    then:
      - ends: well
      - commands: [oven.heat]
      - step: {step: 3, times: 2}
"""


def test_a_whole_file_is_read_with_the_lines_of_what_is_expected():
    file = read_trials(WHOLE.encode())
    (trial,) = file.trials
    assert (file.program, file.site) == ("../a.json", "hall.json")
    assert (trial.name, trial.line, trial.seed, trial.driver, trial.limit_s) == ("All of it", 5, 7, "physics", 60)
    assert (trial.stocks, trial.carrying) == ({"shelf": {"box": 3}}, {"robot": {"can": 1}})
    assert (trial.readings, trial.parameters) == ({"oven": {"temperature": 22, "door": "closed"}}, {"minutes": 3})
    assert trial.faults == (Fault("oven", "fail_next", step="3", nth=2),)
    assert trial.then == (
        Expectation("ends", 18, "well"),
        Expectation("commands", 19, ["oven.heat"]),
        Expectation("step", 20, {"step": "3", "times": 2}),
    )


FAULTS = """    when:
      faults:
        - fault: dead
          device: a
        - fault: explodes
"""


def then(line):
    return f"{HEAD}  - name: a\n    then:\n      - {line}\n"


@pytest.mark.parametrize(
    ("text", "line", "why"),
    [
        ("", 1, "It must begin with “version: 1”"),
        ("version: 2\n", 1, "Write “version: 1”, not 2."),
        ("version: 1\ntests: []\n", 2, "Write 1 to 200 tests"),
        ("version: 1\ntests:\n  - name: a\n    then: [{ends: well}]\n", 1, "Name the program"),
        (f"{HEAD}  - then: [{{ends: well}}]\n", 4, "“name” is a text"),
        (f"{HEAD}  - name: a\n", 4, "Say under “then:” what holds"),
        (f"{HEAD}  - name: a\n    than: []\n", 5, "“than” is not known here. Known are: given, name, then, when."),
        (then("ends: badly"), 6, "Write “ends: well”, or “fails:”"),
        (then("fails: ''"), 6, "Write “ends: well”, or “fails:” and a word of the reason."),
        (then("commands: []"), 6, "commands needs “device.method”."),
        (then("commands: [drop, ' ']"), 6, "commands needs “device.method”."),
        (then(f"within_s: 0x{'F' * 4000}"), 6, "A number has at most 40 characters. Write it shorter."),
        (then("within_s: " + ":".join(["1"] * 50_000)), 6, "A number has at most 40 characters."),
        (then(f"within_s: {'1:' * 300}0.5"), 6, "A number has at most 40 characters."),
        (then('fails: "a\\0b"'), 6, "It is no YAML: U+0000 is no text; take it out."),
        (then('item: {object: box, "a\\uD800": a}'), 6, "It is no YAML: U+D800 is no text; take it out."),
        (f"{HEAD}  - name: ' '\n", 4, "Give the test a name"),
        (then("explodes: now"), 6, "Write one of commands, ends, fails,"),
        (then("within_s: soon"), 6, "“within_s” is a number, not 'soon'."),
        (then("within_s: -1"), 6, "“within_s” is a number from 0 to 604800, not -1."),
        (then("item: {object: box}"), 6, "item needs “at”."),
        (then("item: {object: box, at: a, count: 1.5}"), 6, "“count” is a whole number from 0 to 1000000, not 1.5."),
        (then("never_two_in: {}"), 6, "Write “zone:” with a zone of the program"),
        (then("property: {device: a, name: b}"), 6, "Write one of “is”, “at_least” and “at_most”"),
        (then("ends: well") + FAULTS, 11, "Fault 2: “fault” is one of fails,"),
        (f"{HEAD}  - &a\n    name: b\n", 4, "It uses an anchor (&name) or an alias"),
        ("version: 1\nversion: 1\n", 2, "“version” stands here twice; keep one of the two."),
        ("version: [1\n", 2, "It is no YAML:"),
        ("version: !!python/object:os.system 1\n", 1, "It uses a tag (such as !!str). Write the value alone"),
        (then("within_s: !!int '60'"), 6, "It uses a tag"),
        (then("commands: !!set {oven.heat}"), 6, "It uses a tag"),
        (then("!!str ends: well"), 6, "It uses a tag"),
        (then("fails: ! oven"), 6, "It uses a tag"),
        (then("ends: !own well"), 6, "It uses a tag"),
        (then("ends: well") + then("ends: well").removeprefix(HEAD), 7, "Two tests are called “a”"),
        ("a: " + "[" * 30 + "]" * 30, 1, "It is nested deeper than 20 levels."),
        ("a: [" + "1," * 50_001 + "]", 1, "It holds more than 50000 values."),
    ],
)  # fmt: skip
def test_what_cannot_be_understood_is_refused_with_its_line(text, line, why):
    with pytest.raises(BadTrialFile) as refused:
        read_trials(text.encode())
    assert why in refused.value.why
    assert refused.value.line == line


def test_a_file_that_is_too_large_or_no_text_is_refused_unread():
    for payload, why in ((b"#" * 1_000_001, "larger than 1 MB"), (b"\xff\xfe\xff", "not text in UTF-8")):
        with pytest.raises(BadTrialFile, match=why):
            read_trials(payload)
