"""The command `vipo`: which commands it has, and what is said when one cannot be carried out."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NoReturn

from editor.language.messages.diagnostics import diagnostic_to_json
from vipo_device.descriptions.forms import ANY_FORM, FORMS
from vipo_device.protocol.errors import VipoError
from vipo_site.cli import account, call, devices, history, record, repair, token
from vipo_site.cli.program_file import FaultyScript
from vipo_site.cli.programs import add_program_commands
from vipo_site.cli.terminal import CLEAN, FAULTY, INTERRUPTED, UNUSABLE, Unusable, complain, refuse, write_failure

_NAMES = (
    *("check", "script", "draw", "plan", "rehearse", "test", "scan", "describe"),
    *("call", "devices", "alerts", "approve", "enrolment-key", "account", "token", "mend-program", "history", "record"),
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code: 0 clean, 1 errors in it, 2 nothing could be done, 130 Ctrl-C."""
    asked = sys.argv[1:] if arguments is None else list(arguments)
    options = _options(asked)
    try:
        code = _run(options)
        sys.stdout.flush()
    except BrokenPipeError:
        # nobody reads on; what Python still wants to write at its end goes nowhere
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return CLEAN
    except KeyboardInterrupt:
        return INTERRUPTED
    except OSError as error:
        return _give_up(options, error)
    return code


def _options(asked: Sequence[str]) -> argparse.Namespace:
    """Return what was asked for. Bad usage is told, and raises SystemExit."""
    try:
        return _parser().parse_args(asked)
    except _BadUsage as error:
        refuse(argparse.Namespace(json="--json" in asked), "bad_usage", str(error))
        raise SystemExit(UNUSABLE) from None


def _give_up(options: argparse.Namespace, error: OSError) -> int:
    """Say that a file cannot be used; it may be the answer's own, to which nothing is written then."""
    detail = f"This cannot be done: {error.strerror or error}{f': {error.filename}' if error.filename else ''}."
    try:
        if getattr(options, "json", False):
            write_failure("not_possible", detail)
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return complain(detail)


def _run(options: argparse.Namespace) -> int:
    """Run one command; tell what keeps it from being carried out."""
    try:
        run: Callable[[argparse.Namespace], int] = options.run
        return run(options)
    except FaultyScript as error:
        found = [diagnostic_to_json(diagnostic) for diagnostic in error.diagnostics]
        refuse(options, error.code, error.message_in(options.lang), diagnostics=found)
        return FAULTY
    except Unusable as error:
        return refuse(options, error.code, str(error))
    except VipoError as error:  # a file of kinds that cannot be used, say
        return refuse(options, error.code, error.detail)
    except _setting_error() as error:
        return refuse(options, "bad_setting", str(error))
    except _database_error() as error:
        folder = os.environ.get("VIPO_STATE_DIR", "var")
        return refuse(
            options,
            "no_database",
            f"VIPO's database cannot be used: {error}. Run this with the settings of the VIPO that is running (of the "
            f"demo VIPO_STATE_DIR, which is {folder!r} now), and start that once after an update.",
        )


def _setting_error() -> type[Exception]:
    """Return what missing settings are; looked up only when something went wrong, for that takes time."""
    from django.core.exceptions import ImproperlyConfigured

    return ImproperlyConfigured


def _database_error() -> type[Exception]:
    """Return what database errors are; looked up late, too."""
    from django.db import DatabaseError

    return DatabaseError


def _describe(options: argparse.Namespace) -> int:
    # imported late: reading RDF takes a library that the other commands do not need
    from vipo_device.descriptions.shacl import ShaclMissing
    from vipo_site.cli.describe import describe_file

    try:
        return describe_file(options)
    except ShaclMissing as error:
        return refuse(options, "shacl_missing", str(error))


class _BadUsage(Exception):
    """The command was used wrongly; the message says how, in one sentence."""


class _Parser(argparse.ArgumentParser):
    """Tells of bad usage in one sentence."""

    def error(self, message: str) -> NoReturn:
        raise _BadUsage(f"{message[:1].upper()}{message[1:]}. Try: {self.prog} --help")


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="vipo", description="Check, print, plan and rehearse programs for robots and machines.")
    commands = parser.add_subparsers(required=True, metavar="|".join(_NAMES), parser_class=_Parser)
    add_program_commands(commands)
    _add_test(commands.add_parser("test", help=_TEST, description=_TEST))
    _add_scan(commands.add_parser("scan", help=_SCAN, description=_SCAN))
    _add_describe(commands.add_parser("describe", help=_DESCRIBE, description=_DESCRIBE))
    call.add_arguments(commands.add_parser("call", help=call.WHAT, description=call.WHAT))
    for word, text, add in (
        ("devices", devices.DEVICES, devices.add_devices_arguments),
        ("alerts", devices.ALERTS, devices.add_alerts_arguments),
        ("approve", devices.APPROVE, devices.add_approve_arguments),
        ("account", account.ACCOUNT, account.add_account_arguments),
        ("token", token.WHAT, token.add_token_arguments),
        ("mend-program", repair.WHAT, repair.add_mending_arguments),
        ("history", history.WHAT, history.add_history_arguments),
        ("record", record.WHAT, record.add_record_arguments),
    ):
        add(commands.add_parser(word, help=text, description=text))
    word, text = "enrolment-key", devices.ENROLMENT_KEY
    devices.add_enrolment_key_arguments(commands.add_parser(word, aliases=["join-key"], help=text, description=text))
    return parser


def _add_describe(sub: argparse.ArgumentParser) -> None:
    sub.add_argument("file", type=Path, help=f"a description: {ANY_FORM}")
    sub.add_argument("--to", choices=FORMS, help="write it in this form")
    sub.add_argument("--shacl", action="store_true", help="hold it against the SHACL shapes, too")
    sub.add_argument("--json", action="store_true", help="write JSON for machines")
    sub.set_defaults(run=_describe)


def _add_test(sub: argparse.ArgumentParser) -> None:
    sub.add_argument("files", type=Path, nargs="+", metavar="FILE", help="files of tests (.yaml), or folders of them")
    sub.add_argument("--seeds", type=int, default=0, help="carry each test out with so many seeds, too (at most 1000)")
    sub.add_argument("--mutate", action="store_true", help="name what could be taken out without a test noticing")
    sub.add_argument("--mutants", type=int, default=100, help="try at most so many changes (100)")
    sub.add_argument("--junit", type=Path, help="write JUnit XML into this file, too")
    sub.add_argument("--json", action="store_true", help="write JSON for machines")
    sub.set_defaults(run=_test, lang="en")


def _test(options: argparse.Namespace) -> int:
    # imported late: rehearsing takes libraries that the other commands do not need
    from vipo_site.cli.trials import test_files

    return test_files(options)


def _add_scan(sub: argparse.ArgumentParser) -> None:
    sub.add_argument("--map", type=Path, required=True, metavar="FILE", help="the true floor: a map's .yaml file")
    sub.add_argument(
        "--seed", type=int, default=1, help="a course of noise and slip of its own, from 0 to 2147483647 (1)"
    )
    sub.add_argument("--lidar", type=float, default=8.0, metavar="M", help="how far the lidar sees, in metres (8)")
    sub.add_argument("--odometry", type=float, default=0.05, metavar="SHARE", help="how wrong the wheels are (0.05)")
    sub.add_argument("--start", type=float, nargs=3, metavar=("X", "Y", "THETA"), help="where to begin (most room)")
    sub.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for map.yaml and map.pgm")
    sub.add_argument("--json", action="store_true", help="write JSON for machines")
    sub.set_defaults(run=_scan)


def _scan(options: argparse.Namespace) -> int:
    # imported late: planning ways takes libraries that the other commands do not need
    from vipo_site.cli.scan import scan

    return scan(options)


_TEST = "Carry out tests of programs in simulation, in virtual time, and say what did not hold."
_SCAN = "Let a simulated robot map a floor with its lidar, and say how good its map is."
_DESCRIBE = "Say what a device's description holds and what is wrong with it, or write it in another form."


if __name__ == "__main__":
    sys.exit(main())
