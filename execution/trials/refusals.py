"""Why a test, or its file, cannot be read: each sentence by its code, so that screens say it in their language.

Whoever adds a refusal to the readers of tests, of YAML or of faults adds its sentence here; a test names those without.
"""

from __future__ import annotations

import re
from typing import Any

from editor.language.messages.sentences import Sentences

SENTENCES = {
    "begins": "It must begin with “version: {version}”, then “program:” and “tests:”.",
    "version": "Write “version: {version}”, not {value}.",
    "list_of_tests": "Write 1 to {most} tests as a list under “tests:”.",
    "no_program": "Name the program: “program: ../paint-order.json”.",
    "no_name": "Give the test a name: “name: One box, all goes well”.",
    "nothing_holds": "Say under “then:” what holds, as a list, such as “- ends: well”.",
    "one_of": "Write one of {known}, a colon and what is expected.",
    "ends": "Write “ends: well”, or “fails:” and a word of the reason.",
    "zone_or_place": "Write “zone:” with a zone of the program, or “place:” with a place of the site.",
    "compared": "Write one of “is”, “at_least” and “at_most” beside the device and the name.",
    "driver": "The driver is physics or kinematic, not {value}.",
    "number_between": "“{word}” is a number from {low} to {high}, not {value}.",
    "number": "“{word}” is a number, not {value}.",
    "whole": "“{word}” is a whole number from {low} to {most}, not {value}.",
    "text_value": "“{word}” is a text of at most {most} characters, not {value}.",
    "text": "“{word}” is a text of at most {most} characters.",
    "table": "Here stand words, each with a colon and a value.",
    "unknown_word": "“{word}” is not known here. Known are: {known}.",
    "same_name": "Two tests are called “{name}”; give each a name of its own.",
    "no_device": "There is no device “{device}” in the site. There are: {known}.",
    "no_device_at_all": "There is no device “{device}” in the site. There is none.",
    "no_property": "{device} has no property “{name}”.",
    "given_value": "The reading {name} of {device} is a {type}; {value} is none.",
    "given_holder": "{device} is a {kind}; write what it holds under “{other}”.",
    "no_parameter": "The program has no parameter “{name}”. There are: {known}.",
    "no_parameter_at_all": "The program has no parameter “{name}”. There is none.",
    "no_zone": "There is no zone “{name}”. There are: {known}.",
    "no_zone_at_all": "There is no zone “{name}”. There is none.",
    "no_place": "There is no place “{name}”. There are: {known}.",
    "no_place_at_all": "There is no place “{name}”. There is none.",
    "no_step": "The program has no step “{name}”. There are: {known}.",
    "no_step_at_all": "The program has no step “{name}”. There is none.",
    "anchor": "It uses an anchor (&name) or an alias (*name). Write out what it stands for.",
    "tag": "It uses a tag (such as !!str). Write the value alone, a text in quotes.",
    "too_many_values": "It holds more than {most} values. Split it into several files.",
    "too_deep": "It is nested deeper than {most} levels. No test needs that.",
    "too_large": "It is larger than {most} MB. Split it into several files.",
    "too_long": "A test has at most {most} characters. Make two of it.",
    "no_text": "It is not text in UTF-8.",
    "no_yaml": "It is no YAML: {words}.",
    "plain_word": "A word before a colon must be plain text.",
    "long_number": "A number has at most {most} characters. Write it shorter.",
    "twice": "“{word}” stands here twice; keep one of the two.",
    "faults_form": "Write the faults as {form}.",
    "faults_version": "The faults have the version {value}; this VIPO reads up to {version}.",
    "beside_faults": "{word} is not known beside the faults; remove it.",
    "faults_step": "the program has no step {name}.",
    "faults_device": "there is no device {device} here. There are: {known}.",
    "no_robot": "{device} is no robot; only robots drop things and run on batteries.",
    "no_battery": "{device} does not say how full its battery is, so it cannot run low.",
    "faults_property": "{device} has no property {name}. It has: {known}.",
    "faults_value": "{name} is a {type}; {value} is none.",
    "faults_entry": "write it with “device” and “fault”.",
    "faults_word": "“fault” is one of {known}, not {value}.",
    "for_how_long": "a device that is {word} by chance needs “for_s”: how many seconds.",
    "unknown_of": "“{word}” is not known of {fault}. Known are: {known}.",
    "needs": "{kind} needs “{word}”.",
    "begins_once": "it begins once: write {words}, not both.",
}  # fmt: skip
"""What is written more narrowly stands before what would fit, too."""
_sentences = Sentences(SENTENCES)
_FAULT = re.compile(r"Fault (\d+): (.+)", re.DOTALL)


def cause_of_refusal(why: str) -> dict[str, Any] | None:
    """Return `{code, args}` of a refusal, `args.fault` counting the fault that it is of; None for other words."""
    of_fault = _FAULT.fullmatch(why)
    found = _sentences.find(of_fault[2] if of_fault else why)
    if found is None:
        return None
    code, args = found
    return {"code": code, "args": {**args, "fault": of_fault[1]} if of_fault else args}
