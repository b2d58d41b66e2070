"""How lines of the log look, and what is never in them."""

from __future__ import annotations

import json
import logging
import sys

import pytest

from vipo_device.kit.log_ids import add_ids, bind_ids, bound_ids
from vipo_site.logs import JsonLines, TextLines

FIELDS = {"time", "level", "logger", "message", "process", "pid"}


def record(message: str, *args: object, **extra: object) -> logging.LogRecord:
    made = logging.LogRecord("execution.gateway", logging.WARNING, __file__, 7, message, args, None)
    made.__dict__.update(extra)
    return made


def test_a_line_is_one_object_that_says_what_it_belongs_to() -> None:
    with bind_ids({"request": "r-1", "site": "hall", "run": ""}):
        add_ids({"command": "c-1"})
        told = json.loads(JsonLines("gateway").format(record("Device %s said\nno", "m1")))
    assert set(told) == FIELDS | {"request", "site", "command"}
    assert (told["message"], told["process"], told["site"]) == ("Device m1 said\nno", "gateway", "hall")
    assert dict(bound_ids()) == {}


def test_a_line_stays_one_line_whatever_somebody_sends() -> None:
    hostile = 'x\n{"level": "ERROR", "message": "made up"}\r\n\u2028"\x00'
    with bind_ids({"device": hostile}):
        line = JsonLines().format(record("%s", hostile))
    assert "\n" not in line
    assert json.loads(line)["device"] == hostile
    assert json.loads(line)["level"] == "WARNING"


def test_what_a_library_hangs_on_its_records_is_left_out_and_an_exception_is_told() -> None:
    try:
        int("what went wrong")
    except ValueError:
        made = record("Failed", request="<with a secret body>", headers={"Authorization": "Bearer secret"})
        made.exc_info = sys.exc_info()
    line = JsonLines("web").format(made)
    assert "secret" not in line
    assert json.loads(line)["exception"].endswith("'what went wrong'")


def test_people_read_the_ids_behind_the_message() -> None:
    with bind_ids({"run": "r7", "request": "q"}):
        assert TextLines().format(record("Paused")).endswith("WARNING execution.gateway: Paused [request=q run=r7]")
    assert TextLines().format(record("Paused")).endswith(": Paused")


def test_ids_end_with_their_block_also_when_it_fails() -> None:
    with bind_ids({"site": "hall"}):
        with pytest.raises(KeyError), bind_ids({"run": "r7"}):
            raise KeyError
        assert dict(bound_ids()) == {"site": "hall"}
