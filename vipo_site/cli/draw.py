"""`vipo draw`: a script becomes a program file with a drawing."""

from __future__ import annotations

import argparse
import json
import os
import sys
from pathlib import Path
from typing import Any

from editor.language import compile_document, compiled_to_json, tree_to_document
from vipo_site.cli.program_file import FILE_VERSION, ProgramFile, UnreadableFile, read_program_file


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Say what `vipo draw` takes besides a file and its site."""
    sub.add_argument("-o", "--output", type=Path, help="the program file to write (standard output)")
    sub.add_argument(
        "--over", type=Path, help="a program whose steps keep their places and ids where they are the same"
    )


def draw_file(program: ProgramFile, options: argparse.Namespace) -> int:
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
