"""What can be wrong with what a device sends, or was mended in it: a sentence for each code; pure.

A screen says it in its own language from the code and its arguments; logs, the command line and old readers have the
English text beside them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from vipo_device.protocol.fault_texts import SENTENCES

MOST_CHARACTERS = 200
JSON_SYNTAX: Mapping[str, str] = {
    "Expecting value": "json_value",
    "Expecting property name": "json_key",
    "Expecting ':'": "json_colon",
    "Expecting ','": "json_comma",
    "Illegal trailing comma": "json_trailing",
    "Unterminated string": "json_string",
    "Invalid control character": "json_control",
    "Invalid \\": "json_escape",
    "Extra data": "json_extra",
}
"""The codes of what Python's reader complains of, by how its words begin."""


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that is wrong, or was mended: a sentence, and where: a line and column from 1, or a path into JSON.

    `code` and `args` are what the sentence is made of; a sentence of no code stands for itself.
    """

    text: str
    line: int = 0
    column: int = 0
    path: str = ""
    code: str = ""
    args: Mapping[str, Any] = field(default_factory=dict)

    @property
    def sentence(self) -> str:
        """The sentence with its place."""
        if self.line:
            return f"{self.text} See line {self.line}, column {self.column}."
        return f"{self.text} See {self.path}." if self.path else self.text

    def about(self, it: str) -> Fault:
        """Return the same of something else, such as “The description” instead of “The message”."""
        if "it" not in self.args:
            return self
        return fault(self.code, self.line, self.column, self.path, **{**self.args, "it": it})


def fault(code: str, line: int = 0, column: int = 0, path: str = "", /, **args: str | float) -> Fault:
    """Return the fault of a code with its arguments, which are made fit to be shown: strangers have sent them."""
    shown = {name: _shown(value) for name, value in args.items()}
    return Fault(SENTENCES[code].format_map(shown), line, column, _shown(path), code, shown)


def note(code: str, line: int = 0, **args: str | float) -> Fault:
    """Return what was mended or left out, its text beginning with the line where there is one."""
    found = fault(code, line, **args)
    text = f"Line {line}: {found.text[:1].lower()}{found.text[1:]}" if line else found.text
    return Fault(text, line, code=code, args=found.args)


def bare(text: str) -> Fault:
    """Return a sentence without a code as a fault."""
    return Fault(printable(text))


def facts_of(faults: Iterable[Fault]) -> dict[str, Any]:
    """Return what a screen says faults from: `{"faults": [{text, line, column, path, code, args}]}`."""
    return {"faults": [asdict(each) for each in faults]}


def refusal_facts(code: str, **args: str | float) -> tuple[str, dict[str, Any]]:
    """Return the sentence of a code and what a screen says it from: the arguments of a refusal that is no fault's."""
    found = fault(code, **args)
    return found.sentence, facts_of([found])


def _shown(value: Any) -> Any:
    return printable(value)[:MOST_CHARACTERS] if isinstance(value, str) else value


def printable(text: str) -> str:
    """Return a text without what a terminal would obey, a log would break at, or a page would hide."""
    return "".join(c if c.isprintable() else "\ufffd" for c in text)
