"""`vipo check`, `script`, `draw`, `plan` and `rehearse`: what can be done with a program's file."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from editor.language import compile_document, compiled_to_json, plan_to_json, tree_to_document
from editor.language.compiler import Compiled
from editor.language.messages.phrases import LANGUAGES, Language
from vipo_site.cli.program_file import FILE_VERSION, ProgramFile, UnreadableFile, read_program_file
from vipo_site.cli.rehearsal_report import result_with_words, say_result
from vipo_site.cli.terminal import CLEAN, FAULTY, complain, refuse_seed, write, write_failure, write_json

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


def add_program_commands(commands: argparse._SubParsersAction[Any]) -> None:
    """Describe the commands that take a program's file."""
    for name, command, text in _COMMANDS:
        sub = commands.add_parser(name, help=text, description=text)
        sub.add_argument("file", type=Path, help="a program file (.json), a document (.json) or a script (.py)")
        sub.add_argument("--site", type=Path, help="the site file, when the program file names none")
        sub.add_argument("--json", action="store_true", help="write JSON for machines")
        sub.add_argument("--lang", choices=LANGUAGES, default="en", help="the language of what the checks say (en)")
        sub.set_defaults(command=command, run=_run_on_program)
        if name == "draw":
            _add_draw_arguments(sub)
        if name == "rehearse":
            _add_rehearse_arguments(sub)


def _add_draw_arguments(sub: argparse.ArgumentParser) -> None:
    sub.add_argument("-o", "--output", type=Path, help="the program file to write (standard output)")
    sub.add_argument(
        "--over", type=Path, help="a program whose steps keep their places and ids where they are the same"
    )


def _add_rehearse_arguments(sub: argparse.ArgumentParser) -> None:
    sub.add_argument("--seed", type=int, default=0, help="a course of chance, from 1 to 2147483647; 0: no chance (0)")
    sub.add_argument("--driver", choices=("physics", "kinematic"), default="physics", help="who drives (physics)")


def _run_on_program(options: argparse.Namespace) -> int:
    command: Callable[[ProgramFile, argparse.Namespace], int] = options.command
    return command(read_program_file(options.file, options.site), options)


def _check(program: ProgramFile, options: argparse.Namespace) -> int:
    compiled = _compile(program)
    if options.json:
        write_json(compiled_to_json(compiled))
        return _code(compiled)
    for line in _report(compiled, options.lang):
        write(line)
    errors, warnings = _counts(compiled)
    words = _WORDS[options.lang]
    write(f"{program.name}: {_count(errors, *words['errors'])}, {_count(warnings, *words['warnings'])}.")
    return _code(compiled)


def _script(program: ProgramFile, options: argparse.Namespace) -> int:
    compiled = _compile(program)
    if options.json:
        write_json({key: compiled_to_json(compiled)[key] for key in ("script", "lines", "numbers")})
    else:
        sys.stdout.write(compiled.script)
        _complain_of_errors(compiled, options.lang)
    return _code(compiled)


def _plan(program: ProgramFile, options: argparse.Namespace) -> int:
    compiled = _compile(program)
    if compiled.plan is None:
        return _refuse_errors(program, compiled, options)
    body = plan_to_json(compiled.plan)
    if options.json:
        write_json(body)
        return CLEAN
    for address, instruction in enumerate(body["instructions"]):
        number = compiled.numbers.get(instruction["step"], "")
        write(f"{address:4} {number:8} {instruction['do']:9} {_details(instruction)}".rstrip())
    return CLEAN


def _rehearse(program: ProgramFile, options: argparse.Namespace) -> int:
    refuse_seed(options.seed)
    compiled = _compile(program)
    if compiled.plan is None:
        return _refuse_errors(program, compiled, options)
    # imported late: rehearsing loads the physics, the other commands do not need it
    from execution.rehearsals.program_file import rehearse_program

    result = rehearse_program(
        document=program.document, site=dict(program.site), seed=options.seed, driver=options.driver
    )
    if options.json:
        write_json(result_with_words(compiled, result))
    else:
        for line in say_result(program.name, compiled, result):
            write(line)
    return CLEAN if result["ok"] else FAULTY


def _draw(program: ProgramFile, options: argparse.Namespace) -> int:
    """Write a program as a program file; steps that have no place stand near their devices. Return the exit code."""
    document = _drawn(program, options)
    body = {"vipo": FILE_VERSION, "name": program.name, "document": document, "site": _site_for(program, options)}
    if options.json:
        body = {**body, **compiled_to_json(compile_document(document, program.surroundings))}
    text = json.dumps(body, ensure_ascii=False, indent=1) + "\n"
    if options.output is None:
        sys.stdout.write(text)
        return 0
    try:
        options.output.write_text(text, encoding="utf-8")
    except OSError as error:
        raise UnreadableFile(f"{options.output} cannot be written: {error.strerror or error}.") from error
    return 0


def _drawn(program: ProgramFile, options: argparse.Namespace) -> dict[str, Any]:
    if options.over is None:
        return dict(program.document)
    before = read_program_file(options.over, options.site)
    tree = compile_document(program.document, program.surroundings).tree
    return tree_to_document(tree, program.surroundings, before.document)


def _site_for(program: ProgramFile, options: argparse.Namespace) -> object:
    """Return the site as the file names it: by its path where it has one, seen from where the file goes."""
    if options.site is None:
        return dict(program.site)
    folder = options.output.parent if options.output is not None else Path()
    return os.path.relpath(options.site, folder)


_COMMANDS: tuple[tuple[str, Callable[[ProgramFile, argparse.Namespace], int], str], ...] = (
    ("check", _check, "Say what is wrong with a program, or odd about it."),
    ("script", _script, "Print a program as a task script."),
    ("draw", _draw, "Turn a script into a program file with a drawing."),
    ("plan", _plan, "Print the instructions that a run carries out."),
    ("rehearse", _rehearse, "Run a program in simulation, in virtual time, and say how it went."),
)


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


def _refuse_errors(program: ProgramFile, compiled: Compiled, options: argparse.Namespace) -> int:
    """Say which errors keep a program from being carried out; return the exit code."""
    if options.json:
        errors = _count(_counts(compiled)[0], "error", "errors")
        detail = f"{program.name} has {errors} and cannot be carried out. Try: vipo check {options.file}"
        write_failure("not_ready", detail, diagnostics=compiled_to_json(compiled)["diagnostics"])
    _complain_of_errors(compiled, options.lang)
    return FAULTY


def _complain_of_errors(compiled: Compiled, language: Language) -> None:
    for line in _report(compiled, language):
        if line.startswith(_WORDS[language]["errors"][0]):
            complain(line)


def _details(instruction: Mapping[str, Any]) -> str:
    hidden = {"do", "step", "line", "enters", "leaves"}
    shown = {key: value for key, value in instruction.items() if key not in hidden and value not in (None, [], {})}
    return " ".join(f"{key}={json.dumps(value, ensure_ascii=False)}" for key, value in shown.items())
