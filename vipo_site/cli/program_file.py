"""A program as a file: its document and its site, read with sentences for everything that can be wrong."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from editor.language import (
    Diagnostic,
    FloorFacts,
    Surroundings,
    UnreadableSite,
    parse_script,
    surroundings_from_json,
    tree_to_document,
)
from editor.language.messages.phrases import Language
from registry.floorplan.map_server import read_map
from registry.floorplan.plan import FloorPlan
from vipo_device.protocol.errors import VipoError
from vipo_site.cli.terminal import Unusable

FILE_VERSION = 1
MOST_BYTES = 20_000_000


class UnreadableFile(Unusable):
    """A file cannot be used; the message says why and how to mend it."""

    code = "unreadable_file"


class FaultyScript(UnreadableFile):
    """A script leaves the language; `diagnostics` say where."""

    code = "bad_script"

    def __init__(self, path: Path, diagnostics: tuple[Diagnostic, ...]) -> None:
        super().__init__("\n".join(f"{path}: {diagnostic.message}" for diagnostic in diagnostics))
        self.path = path
        self.diagnostics = diagnostics

    def message_in(self, language: Language) -> str:
        """Return a line for each diagnostic."""
        return "\n".join(f"{self.path}: {diagnostic.message_in(language)}" for diagnostic in self.diagnostics)


@dataclass(frozen=True, slots=True)
class ProgramFile:
    """A program with the site it is for. `site` is the site's JSON; a grid in it has an absolute path."""

    name: str
    document: Mapping[str, Any]
    site: Mapping[str, Any]
    surroundings: Surroundings


def read_program_file(path: Path, site_path: Path | None) -> ProgramFile:
    """Read a program file, a bare document or a script.

    Raises:
        UnreadableFile: it cannot be read, or it is none of these.
    """
    text = _read_text(path)
    if path.suffix == ".py":
        site, surroundings = _site(None, path, site_path)
        return ProgramFile(path.stem, _document_of_script(text, path, surroundings), site, surroundings)
    body = _json(text, path)
    if "vipo" not in body and "steps" in body:
        site, surroundings = _site(None, path, site_path)
        return ProgramFile(path.stem, body, site, surroundings)
    document = body.get("document")
    if body.get("vipo") != FILE_VERSION or not isinstance(document, Mapping):
        raise UnreadableFile(
            f"{path} is no program file. It needs “vipo”: {FILE_VERSION} and a “document”, or to be a document itself."
        )
    site, surroundings = _site(body.get("site"), path, site_path)
    return ProgramFile(str(body.get("name", path.stem)), document, site, surroundings)


def _document_of_script(text: str, path: Path, surroundings: Surroundings) -> Mapping[str, Any]:
    parsed = parse_script(text, surroundings)
    if parsed.tree is None:
        raise FaultyScript(path, parsed.diagnostics)
    return tree_to_document(parsed.tree, surroundings)


def read_bounded(path: Path, what: str) -> bytes:
    """Return what stands in a file (`-`: comes on standard input), of which no more is read than may be.

    Raises UnreadableFile.
    """
    try:
        with nullcontext(sys.stdin.buffer) if str(path) == "-" else path.open("rb") as file:
            payload = file.read(MOST_BYTES + 1)
    except (OSError, ValueError) as error:  # the latter: a name that no file can have
        raise UnreadableFile(f"{path} cannot be read: {getattr(error, 'strerror', None) or error}.") from error
    if len(payload) > MOST_BYTES:
        raise UnreadableFile(f"{path} is larger than {MOST_BYTES // 1_000_000} MB. That is no {what}.")
    return payload


def _read_text(path: Path) -> str:
    try:
        return read_bounded(path, "program").decode().replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as error:
        raise UnreadableFile(f"{path} is not text in UTF-8.") from error


def _json(text: str, path: Path) -> dict[str, Any]:
    try:
        body = json.loads(text)
    except json.JSONDecodeError as error:
        raise UnreadableFile(f"{path} is not JSON: line {error.lineno}, column {error.colno}: {error.msg}.") from error
    except (RecursionError, ValueError) as error:
        raise UnreadableFile(f"{path} is not JSON that can be read: {error}.") from error
    if not isinstance(body, dict):
        raise UnreadableFile(f"{path} must hold a JSON object.")
    return body


def _site(given: object, path: Path, site_path: Path | None) -> tuple[dict[str, Any], Surroundings]:
    """Return the site: the file named on the command line, or the one in or named by the program file."""
    where = path
    if site_path is None and isinstance(given, str):
        site_path = path.parent / given
    if site_path is not None:
        where, given = site_path, _json(_read_text(site_path), site_path)
    if given is None:
        raise UnreadableFile(
            f"{path} names no site. Give one with --site, or in a file of tests with site:, such as "
            "examples/painting-factory.json"
        )
    if not isinstance(given, dict):
        raise UnreadableFile(f"The site in {where} must be a JSON object with “devices” and “places”.")
    site = _with_absolute_grid(given, where)
    try:
        plain = surroundings_from_json(site)
        floor = _floor(site, plain)
    except UnreadableSite as error:
        raise UnreadableFile(f"{where}: {error}") from error
    return site, replace(plain, floor=floor)


def _with_absolute_grid(site: dict[str, Any], where: Path) -> dict[str, Any]:
    grid = site.get("grid")
    if grid is None:
        return site
    if not isinstance(grid, Mapping) or not isinstance(grid.get("yaml"), str):
        raise UnreadableFile(f"The “grid” in {where} must be an object with the path of a map's “yaml”.")
    return {**site, "grid": {**grid, "yaml": str((where.parent / grid["yaml"]).resolve())}}


def _floor(site: Mapping[str, Any], surroundings: Surroundings) -> FloorFacts | None:
    if "grid" not in site:
        return None
    path = Path(site["grid"]["yaml"])
    header = _read_text(path)
    image_name = next((line.split(":", 1)[1].strip() for line in header.splitlines() if line.startswith("image:")), "")
    image = path.parent / image_name.strip("'\"")
    try:
        grid = read_map(header.encode(), image.read_bytes())
    except OSError as error:
        raise UnreadableFile(f"The map's image {image} cannot be read: {error.strerror or error}.") from error
    except VipoError as error:
        raise UnreadableFile(f"The map {path} cannot be used: {error}") from error
    machines = [f.description for f in surroundings.devices.values() if f.description.kind == "machine"]
    return FloorPlan(grid, [m for m in machines if surroundings.devices[m.id].lifecycle == "approved"])
