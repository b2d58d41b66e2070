"""Refusals of execution.

ExecutionError
 ├── NotFound: no such run, rehearsal or program here
 ├── NotReady: the program has errors and cannot be carried out
 ├── BadTerms: a run cannot begin or be over at such a time
 ├── NotPossibleNow: the run is over, the site is stopped
 ├── AlreadyAnswered: somebody else was quicker
 ├── AnswerNotFitting: the answer is not what was asked for
 ├── BadArguments: a method does not take these arguments
 ├── ActionFailed: a device did not do what it was told
 ├── TooManyWaiting: as many wait for results as may
 ├── TooManyRehearsals: as many rehearsals wait or are under way as may
 ├── BadTest: a test's text cannot be read
 ├── TestChanged: a test is not what its writer has read
 ├── TestTagNeeded: somebody writes without saying what they read
 ├── TestNameTaken: another test of the program is called so
 ├── TestsFull: a program has as many tests as it may
 ├── HistoryUnreadable: it is in the archive, and that cannot be read here now
 ├── BadKeeping: nothing can be kept for so many days
 └── NoWay: there is no route
"""

from __future__ import annotations

from vipo_device.protocol.errors import VipoError


class ExecutionError(VipoError):
    """A refusal of execution."""

    code = "execution"


class NotFound(ExecutionError):
    """It does not exist, or not for this person."""

    code = "not_found"
    status = 404


class NotReady(ExecutionError):
    """The program cannot be carried out as it is."""

    code = "not_ready"
    status = 422


class BadTerms(ExecutionError):
    """A time that a run is to begin or to be over at makes no sense."""

    code = "bad_terms"
    status = 422


class NotPossibleNow(ExecutionError):
    """It cannot be done in the state that things are in."""

    code = "not_possible_now"
    status = 409


class AlreadyAnswered(ExecutionError):
    """Somebody else has answered the question."""

    code = "already_answered"
    status = 409


class AnswerNotFitting(ExecutionError):
    """The answer is not what was asked for."""

    code = "answer_not_fitting"
    status = 422


class BadArguments(ExecutionError):
    """A method that the device does not have, or arguments that it does not take."""

    code = "bad_arguments"
    status = 422


class ActionFailed(ExecutionError):
    """The device refused, failed or gave up; no proxy sends a 409 again by itself."""

    code = "action_failed"
    status = 409


class TooManyWaiting(ExecutionError):
    """This process lets so many wait for what comes of a call, in all or of this person; nothing was done."""

    code = "too_many_waiting"
    status = 429


class TooManyRehearsals(ExecutionError):
    """A person or a site has as many rehearsals that wait or are under way as it may; none was queued."""

    code = "too_many_rehearsals"
    status = 429
    retry_after_s = 30


class BadTest(ExecutionError):
    """A test, or a file of tests, cannot be read; `line` counts from 1 (0: unknown)."""

    code = "bad_test"
    status = 422


class TestChanged(ExecutionError):
    """Somebody else has written a test since it was read; nothing was changed."""

    code = "changed"
    status = 412


class TestTagNeeded(ExecutionError):
    """The header If-Match is missing."""

    code = "if_match_needed"
    status = 428


class TestNameTaken(ExecutionError):
    """A file of tests has each name once."""

    code = "test_name_taken"
    status = 409


class TestsFull(ExecutionError):
    """There is no room for more tests."""

    code = "tests_full"
    status = 409


class HistoryUnreadable(ExecutionError):
    """It is in the archive, and the archive's folder or this file of it cannot be read by this process now."""

    code = "history_unreadable"
    status = 503


class BadKeeping(ExecutionError):
    """A time of keeping that is too long to be one."""

    code = "bad_keeping"
    status = 422


class NoWay(ExecutionError):
    """No robot can drive there."""

    code = "no_way"
    status = 422
