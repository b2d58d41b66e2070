"""`vipo`: check, print, plan and rehearse a program file from the command line."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

from editor.language import compile_document, compiled_to_json, plan_to_json
from editor.language.compiler import Compiled, diagnostic_to_json
from editor.language.messages.phrases import LANGUAGES, Language
from vipo_device.descriptions.forms import FORMS
from vipo_site.cli import account, call, devices
from vipo_site.cli.draw import add_arguments as add_draw_arguments
from vipo_site.cli.draw import draw_file
from vipo_site.cli.program_file import FaultyScript, ProgramFile, UnreadableFile, read_program_file

CLEAN, FAULTY, UNUSABLE, INTERRUPTED = 0, 1, 2, 130
_WORDS: Mapping[Language, Mapping[str, tuple[str, ...]]] = {
    "en": {
        "errors": ("error", "errors"), "warnings": ("warning", "warnings"),
        "step": ("step",), "line": ("line",), "program": ("program",),
    },
    "de": {
        "errors": ("Fehler", "Fehler"), "warnings": ("Hinweis", "Hinweise"),
        "step": ("Schritt",), "line": ("Zeile",), "program": ("Programm",),
    },
}  # fmt: skip


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code: 0 clean, 1 errors in it, 2 nothing could be done, 130 Ctrl-C."""
    options = _parser().parse_args(arguments)
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
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        _complain(f"This cannot be done: {error.strerror or error}{f': {error.filename}' if error.filename else ''}.")
        return UNUSABLE
    return code


def _run(options: argparse.Namespace) -> int:
    """Run one command; tell what keeps it from being carried out."""
    try:
        run: Callable[[argparse.Namespace], int] = options.run
        return run(options)
    except FaultyScript as error:
        if options.json:
            _write_json({"diagnostics": [diagnostic_to_json(diagnostic) for diagnostic in error.diagnostics]})
        else:
            for diagnostic in error.diagnostics:
                _complain(f"{error.path}: {diagnostic.message_in(options.lang)}")
        return FAULTY
    except UnreadableFile as error:
        _complain(str(error))
        return UNUSABLE
    except _setting_error() as error:
        _complain(str(error))
        return UNUSABLE
    except _database_error() as error:
        folder = os.environ.get("VIPO_STATE_DIR", "var")
        _complain(
            f"VIPO's database cannot be used: {error}. Run this with the settings of the VIPO that is running (of the "
            f"demo VIPO_STATE_DIR, which is {folder!r} now), and start that once after an update."
        )
        return UNUSABLE


def _setting_error() -> type[Exception]:
    """Return what missing settings are; looked up only when something went wrong, for that takes time."""
    from django.core.exceptions import ImproperlyConfigured

    return ImproperlyConfigured


def _database_error() -> type[Exception]:
    """Return what database errors are; looked up late, too."""
    from django.db import DatabaseError

    return DatabaseError


def _run_on_program(options: argparse.Namespace) -> int:
    command: Callable[[ProgramFile, argparse.Namespace], int] = options.command
    return command(read_program_file(options.file, options.site), options)


def _describe(options: argparse.Namespace) -> int:
    # imported late: reading RDF takes a library that the other commands do not need
    from vipo_site.cli.describe import describe_file

    return describe_file(options)


class _Parser(argparse.ArgumentParser):
    """Tells of bad usage in one sentence."""

    def error(self, message: str) -> NoReturn:
        _complain(f"{message[:1].upper()}{message[1:]}. Try: {self.prog} --help")
        raise SystemExit(UNUSABLE)


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="vipo", description="Check, print, plan and rehearse programs for robots and machines.")
    names = "|".join(
        [*(name for name, _, _ in _COMMANDS), "describe", "call", "devices", "alerts", "approve", "join-key"]
    )
    commands = parser.add_subparsers(required=True, metavar=names, parser_class=_Parser)
    for name, command, text in _COMMANDS:
        sub = commands.add_parser(name, help=text, description=text)
        sub.add_argument("file", type=Path, help="a program file (.json), a document (.json) or a script (.py)")
        sub.add_argument("--site", type=Path, help="the site file, when the program file names none")
        sub.add_argument("--json", action="store_true", help="write JSON for machines")
        sub.add_argument("--lang", choices=LANGUAGES, default="en", help="the language of what the checks say (en)")
        sub.set_defaults(command=command, run=_run_on_program)
        if name == "draw":
            add_draw_arguments(sub)
        if name == "rehearse":
            sub.add_argument("--seed", type=int, default=0, help="another seed, another course of chance (0)")
            sub.add_argument(
                "--driver", choices=("physics", "kinematic"), default="physics", help="who drives (physics)"
            )
    _add_describe(commands.add_parser("describe", help=_DESCRIBE, description=_DESCRIBE))
    call.add_arguments(commands.add_parser("call", help=call.WHAT, description=call.WHAT))
    for word, text, add in (
        ("devices", devices.DEVICES, devices.add_devices_arguments),
        ("alerts", devices.ALERTS, devices.add_alerts_arguments),
        ("approve", devices.APPROVE, devices.add_approve_arguments),
        ("join-key", devices.JOIN_KEY, devices.add_join_key_arguments),
        ("account", account.ACCOUNT, account.add_account_arguments),
    ):
        add(commands.add_parser(word, help=text, description=text))
    return parser


def _add_describe(sub: argparse.ArgumentParser) -> None:
    sub.add_argument("file", type=Path, help="a description: Turtle, N-Triples, JSON-LD, a TD or the paper's message")
    sub.add_argument("--to", choices=FORMS, help="write it in this form")
    sub.add_argument("--shacl", action="store_true", help="hold it against the SHACL shapes, too")
    sub.add_argument("--json", action="store_true", help="write JSON for machines")
    sub.set_defaults(run=_describe)


def _check(program: ProgramFile, options: argparse.Namespace) -> int:
    compiled = _compile(program)
    if options.json:
        _write_json(compiled_to_json(compiled))
        return _code(compiled)
    for line in _report(compiled, options.lang):
        _write(line)
    errors, warnings = _counts(compiled)
    words = _WORDS[options.lang]
    _write(f"{program.name}: {_count(errors, *words['errors'])}, {_count(warnings, *words['warnings'])}.")
    return _code(compiled)


def _script(program: ProgramFile, options: argparse.Namespace) -> int:
    compiled = _compile(program)
    if options.json:
        _write_json({key: compiled_to_json(compiled)[key] for key in ("script", "lines", "numbers")})
    else:
        sys.stdout.write(compiled.script)
        _complain_of_errors(compiled, options.lang)
    return _code(compiled)


def _plan(program: ProgramFile, options: argparse.Namespace) -> int:
    compiled = _compile(program)
    if compiled.plan is None:
        if options.json:
            _write_json({"diagnostics": compiled_to_json(compiled)["diagnostics"]})
        _complain_of_errors(compiled, options.lang)
        return FAULTY
    body = plan_to_json(compiled.plan)
    if options.json:
        _write_json(body)
        return CLEAN
    for address, instruction in enumerate(body["instructions"]):
        number = compiled.numbers.get(instruction["step"], "")
        _write(f"{address:4} {number:8} {instruction['do']:9} {_details(instruction)}".rstrip())
    return CLEAN


def _rehearse(program: ProgramFile, options: argparse.Namespace) -> int:
    compiled = _compile(program)
    if compiled.plan is None:
        _complain_of_errors(compiled, options.lang)
        return FAULTY
    # imported late: rehearsing loads the physics, the other commands do not need it
    from execution.rehearsals.program_file import rehearse_program

    result = rehearse_program(
        document=program.document, site=dict(program.site), seed=options.seed, driver=options.driver
    )
    if options.json:
        _write_json(result)
    else:
        _write_result(program, result)
    return CLEAN if result["ok"] else FAULTY


_COMMANDS: tuple[tuple[str, Callable[[ProgramFile, argparse.Namespace], int], str], ...] = (
    ("check", _check, "Say what is wrong with a program, or odd about it."),
    ("script", _script, "Print a program as a task script."),
    ("draw", draw_file, "Turn a script into a program file with a drawing."),
    ("plan", _plan, "Print the instructions that a run carries out."),
    ("rehearse", _rehearse, "Run a program in simulation, in virtual time, and say how it went."),
)


_DESCRIBE = "Say what a device's description holds and what is wrong with it, or write it in another form."


def _compile(program: ProgramFile) -> Compiled:
    return compile_document(program.document, program.surroundings)


def _counts(compiled: Compiled) -> tuple[int, int]:
    severities = [diagnostic.severity for diagnostic in compiled.diagnostics]
    return severities.count("error"), severities.count("warning")


def _count(number: int, one: str, many: str) -> str:
    return f"{number} {one if number == 1 else many}"


def _code(compiled: Compiled) -> int:
    return FAULTY if compiled.plan is None else CLEAN


def _report(compiled: Compiled, language: Language) -> list[str]:
    lines, words = [], _WORDS[language]
    for d in compiled.diagnostics:
        where = f"{words['step'][0]} {compiled.numbers[d.step]}" if d.step in compiled.numbers else d.step
        line = f", {words['line'][0]} {d.line}" if d.line else ""
        severity = words["errors" if d.severity == "error" else "warnings"][0]
        lines.append(f"{severity}: {where or words['program'][0]}{line}: {d.message_in(language)} [{d.code}]")
    return lines


def _complain_of_errors(compiled: Compiled, language: Language) -> None:
    for line in _report(compiled, language):
        if line.startswith(_WORDS[language]["errors"][0]):
            _complain(line)


def _details(instruction: Mapping[str, Any]) -> str:
    hidden = {"do", "step", "line", "enters", "leaves"}
    shown = {key: value for key, value in instruction.items() if key not in hidden and value not in (None, [], {})}
    return " ".join(f"{key}={json.dumps(value, ensure_ascii=False)}" for key, value in shown.items())


def _write_result(program: ProgramFile, result: Mapping[str, Any]) -> None:
    minutes, seconds = divmod(round(result["duration_s"]), 60)
    word = "ends well" if result["ok"] else "does not end well"
    _write(f"{program.name}: {word} after {minutes} min {seconds} s.")
    for error in result["errors"]:
        _write(f"error: at {error['t']:.0f} s, step {error['step'] or 'none'}: {error['message']}")
    for robot, figures in sorted(result["robots"].items()):
        _write(
            f"{robot}: {figures['distance_m']:.1f} m, busy {figures['busy_s']:.0f} s, waits {figures['wait_s']:.0f} s"
        )
    _write(f"Near misses: {len(result['near_misses'])}, collisions: {len(result['collisions'])}.")


def _write(line: str) -> None:
    print(line)  # noqa: T201 - a command line tool speaks by printing


def _write_json(body: object) -> None:
    _write(json.dumps(body, ensure_ascii=False, indent=1))


def _complain(line: str) -> None:
    print(line, file=sys.stderr)  # noqa: T201 - a command line tool speaks by printing


if __name__ == "__main__":
    sys.exit(main())
