"""The text of the paper's message (its Figure 5): lines of `key: value`, mended only where one reading is possible."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NoReturn

from vipo_device.descriptions.forms import DESCRIPTION, BadDescription, paper_key, refuse
from vipo_device.protocol.faults import JSON_SYNTAX, Fault, note
from vipo_device.protocol.messages import BadMessage, parse_json

KEYS = (
    *("id", "name", "description", "kind", "device_class", "site", "location", "size", "imgUrl", "done", "simulated"),
    *("gives", "takes", "capacity", "radius", "speed", "properties", "methods"),
    *("value", "type", "unit", "minimum", "maximum", "options", "title"),
    *("vipo_msg_type", "topic_name", "parameters", "required"),
)
SECTIONS = frozenset({"properties", "methods", "parameters"})
_SPELLINGS: Mapping[str, str] = {paper_key(key): key for key in KEYS}
_LINE = re.compile(r"""(?P<key>"?[A-Za-z](?:[A-Za-z_ -]*[A-Za-z_])?"?)\s*:(?:\s+(?P<value>\S.*))?""")
_NO_COLON = re.compile(r"""(?P<key>[A-Za-z][A-Za-z_-]*)\s*(?P<value>["'].*)?""")
_OTHER_QUOTE = re.compile(r"""(?P<open>["'“”„\u2018\u2019]?)(?P<text>[^"'\\“”„]*?)(?P<close>["'“”\u2019]?)""")
_PLAIN_START = re.compile(r"[^\[{0-9+.-]|[0-9]*[A-Za-z]")


@dataclass(frozen=True, slots=True)
class MessageText:
    """A message as JSON, where each path of it stands, and what was mended to read it."""

    body: dict[str, Any]
    places: Mapping[str, tuple[int, int]]
    notes: tuple[Fault, ...]


@dataclass(frozen=True, slots=True)
class _Line:
    number: int
    indent: int
    begins: bool
    key: str
    value: str
    column: int


@dataclass(slots=True)
class _Reader:
    """Gathers places and notes while the lines become JSON."""

    places: dict[str, tuple[int, int]] = field(default_factory=dict)
    notes: list[Fault] = field(default_factory=list)

    def refuse(self, line: _Line, code: str, **args: str) -> NoReturn:
        refuse(code, line.number, line.column, **args)


def read_text(text: str) -> MessageText:
    """Return what a message's text says. Raises BadDescription with the line for what has no single meaning."""
    reader = _Reader()
    lines = list(_lines(text, reader))
    body = _mapping(reader, lines, "")
    return MessageText(body, reader.places, tuple(sorted(reader.notes, key=lambda told: told.line)))


def _lines(text: str, reader: _Reader) -> Iterator[_Line]:
    begins, outer = False, 0
    for number, raw in enumerate(text.split("\n"), 1):
        line = raw.expandtabs(2).rstrip()
        content = line.lstrip(" ")
        if not content or content.startswith(("#", "---")):
            continue
        indent = len(line) - len(content)
        if content.startswith("-"):
            begins, outer = True, indent
            content = content[1:].lstrip(" ")
            if not content:
                continue
            indent = len(line) - len(content)
        yield _line(reader, number, max(indent, outer + 1) if begins else indent, begins, content)
        begins = False


def _line(reader: _Reader, number: int, indent: int, begins: bool, content: str) -> _Line:
    found = _LINE.fullmatch(content)
    bare = None if found else _NO_COLON.fullmatch(content)
    match = found or bare
    written = match.group("key").strip('"').strip() if match else ""
    key = _SPELLINGS.get(paper_key(written), written)
    value = ((match.group("value") if match else "") or "").strip()
    column = indent + content.find(value) + 1 if value else indent + 1
    line = _Line(number, indent, begins, key, value, column)
    if match is None or (bare and key not in KEYS) or (bare and not value and key not in SECTIONS):
        reader.refuse(line, "paper_line", said=content[:40])
    if bare:
        reader.notes.append(note("mended_colon", number, key=key))
    if key != written:
        reader.notes.append(note("mended_key", number, written=written, key=key))
    return line


def _mapping(reader: _Reader, lines: list[_Line], path: str) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for line, inner in _blocks(reader, lines):
        place = f"{path}/{line.key}"
        if line.key in found:
            reader.refuse(line, "said_twice", meant=line.key)
        reader.places[place] = (line.number, line.column)
        if line.key in SECTIONS and not line.value:
            found[line.key] = _items(reader, inner, place)
        elif inner:
            reader.refuse(inner[0], "paper_under", key=line.key)
        elif not line.value:
            reader.refuse(line, "paper_no_value", key=line.key)
        else:
            found[line.key] = _value(reader, line)
    return found


def _blocks(reader: _Reader, lines: list[_Line]) -> Iterator[tuple[_Line, list[_Line]]]:
    """Return each line of the outermost level with the lines that are set in under it."""
    at = 0
    while at < len(lines):
        end = at + 1
        while end < len(lines) and lines[end].indent > lines[0].indent:
            end += 1
        if lines[at].indent != lines[0].indent:
            reader.refuse(lines[at], "paper_less")
        yield lines[at], lines[at + 1 : end]
        at = end


def _items(reader: _Reader, lines: list[_Line], path: str) -> list[dict[str, Any]]:
    """Split a section where a dash, or without dashes where the key `name`, begins its next entry."""
    if not lines:
        return []
    outer = lines[0].indent
    dashed = any(line.begins for line in lines if line.indent == outer)
    groups: list[list[_Line]] = []
    for line in lines:
        if line.indent == outer and (line.begins if dashed else line.key == "name"):
            groups.append([])
        if not groups:
            reader.refuse(line, "paper_name", section=path.rpartition("/")[2])
        groups[-1].append(line)
    items = []
    for position, group in enumerate(groups):
        place = f"{path}/{position}"
        reader.places[place] = (group[0].number, group[0].column)
        items.append(_mapping(reader, group, place))
    return items


def _value(reader: _Reader, line: _Line) -> Any:
    text = line.value
    if text in ("True", "False"):
        return text == "True"
    try:
        return parse_json(text.encode())
    except BadMessage as error:
        if error.fault.code not in JSON_SYNTAX.values():
            told = error.fault.about(DESCRIPTION)
            raise BadDescription(replace(told, line=line.number, column=line.column)) from error
        mended = _mended(text)
        if mended is None:
            reader.refuse(line, "paper_value", key=line.key, said=text[:60])
        reader.notes.append(note("mended_quotes", line.number, key=line.key, value=mended))
        return mended


def _mended(text: str) -> str | None:
    """Return the text of a value whose quotes are missing or differ; None when it could mean several things."""
    found = _OTHER_QUOTE.fullmatch(text)
    if found is None:
        return None
    quoted = found.group("open") or found.group("close")
    if not quoted and not _PLAIN_START.match(text):
        return None
    return found.group("text").strip() if quoted else text
