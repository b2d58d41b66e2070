"""The part of XPath by which MTConnect's `path` chooses data items: names, `//`, attributes, `|`; pure."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass

MOST_CHARACTERS = 1_000
MOST_STEPS = 16
MOST_NESTED = 8
Test = Callable[[Mapping[str, str]], bool]
_NAME = r"[A-Za-z_][A-Za-z0-9_.-]*"
_TOKEN = re.compile(rf"\s*(//|/|\||\[|\]|\(|\)|@|!=|=|\*|\.|'[^']*'|\"[^\"]*\"|{_NAME}(?::{_NAME})?)")


class BadPath(ValueError):
    """A path that cannot be read; the sentence says where and why."""


@dataclass(frozen=True, slots=True, eq=False)
class Node:
    """An element of the document that a path is held against."""

    name: str
    attributes: Mapping[str, str]
    children: tuple[Node, ...] = ()


@dataclass(frozen=True, slots=True)
class Step:
    """One part of a path: its elements' name (`*` is any), whether they may lie deeper, and what must hold of them."""

    name: str
    is_deep: bool
    tests: tuple[Test, ...]


Way = tuple[Step, ...]


def read_path(text: str) -> tuple[Way, ...]:
    """Return the ways of a path, of which each chooses for itself. Raises BadPath."""
    if len(text) > MOST_CHARACTERS:
        raise BadPath(f"`path` may have {MOST_CHARACTERS} characters.")
    return _Reader(text).read()


def choose(ways: Iterable[Way], document: Node) -> set[str]:
    """Return the ids of the data items that a path names, or that lie below what it names."""
    found = dict.fromkeys(node for way in ways for node in _follow(way, document))
    return {node.attributes["id"] for node in _with_all_below(found) if node.name == "DataItem"}


def _follow(way: Way, document: Node) -> Iterable[Node]:
    nodes: Iterable[Node] = (document,)
    for step in way:
        around = _with_all_below(nodes) if step.is_deep else nodes
        if step.name != ".":
            around = (child for node in around for child in node.children)
        fitting = (n for n in around if step.name in {"*", ".", n.name})
        nodes = dict.fromkeys(n for n in fitting if all(test(n.attributes) for test in step.tests))
    return nodes


def _with_all_below(nodes: Iterable[Node]) -> Iterator[Node]:
    """Give nodes and what lies below them, each once."""
    seen: set[Node] = set()
    waiting = list(nodes)
    while waiting:
        node = waiting.pop()
        if node not in seen:
            seen.add(node)
            waiting += node.children
            yield node


class _Reader:
    """Reads a path from left to right."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._tokens = list(_split(text))
        self._at = self._steps = self._nested = 0

    def read(self) -> tuple[Way, ...]:
        ways = [self._way()]
        while self._take("|"):
            ways.append(self._way())
        if self._at < len(self._tokens):
            raise self._complaint("`/`, `[`, `|` or the end")
        return tuple(ways)

    def _way(self) -> Way:
        if self._take("."):
            return (Step(".", False, ()), *self._further())
        first = self._take("//", "/")
        return (self._step(is_deep=first == "//"), *self._further())

    def _further(self) -> Iterator[Step]:
        while mark := self._take("//", "/"):
            yield self._step(is_deep=mark == "//")

    def _step(self, *, is_deep: bool) -> Step:
        self._steps += 1
        if self._steps > MOST_STEPS:
            raise BadPath(f"`path` may have {MOST_STEPS} steps.")
        name = "*" if self._take("*") else self._name("an element's name")
        tests = []
        while self._take("["):
            tests.append(self._either())
            self._need("]")
        return Step(name, is_deep, tuple(tests))

    def _either(self) -> Test:
        choices = [self._both()]
        while self._take("or"):
            choices.append(self._both())
        return choices[0] if len(choices) == 1 else lambda told: any(test(told) for test in choices)

    def _both(self) -> Test:
        parts = [self._single()]
        while self._take("and"):
            parts.append(self._single())
        return parts[0] if len(parts) == 1 else lambda told: all(test(told) for test in parts)

    def _single(self) -> Test:
        if self._take("not"):
            self._need("(")
            inner = self._nest()
            return lambda told: not inner(told)
        return self._nest() if self._take("(") else self._comparison()

    def _nest(self) -> Test:
        """Read what stands in parentheses, the first of which is taken already."""
        self._nested += 1
        if self._nested > MOST_NESTED:
            raise BadPath(f"`path` may have {MOST_NESTED} pairs of parentheses.")
        inner = self._either()
        self._need(")")
        return inner

    def _comparison(self) -> Test:
        self._need("@")
        name = self._name("an attribute's name")
        mark = self._take("=", "!=")
        if not mark:
            return lambda told: name in told
        value = self._literal()
        if mark == "=":
            return lambda told: told.get(name) == value
        return lambda told: name in told and told[name] != value

    def _literal(self) -> str:
        token = self._peek()
        if token[:1] not in {"'", '"'}:
            raise self._complaint("a text in quotes")
        self._at += 1
        return token[1:-1]

    def _name(self, what: str) -> str:
        token = self._peek()
        if not re.match("[A-Za-z_]", token):
            raise self._complaint(what)
        self._at += 1
        return token.rpartition(":")[2]

    def _peek(self) -> str:
        return self._tokens[self._at][1] if self._at < len(self._tokens) else ""

    def _take(self, *marks: str) -> str:
        token = self._peek()
        if token not in marks:
            return ""
        self._at += 1
        return token

    def _need(self, mark: str) -> None:
        if not self._take(mark):
            raise self._complaint(f"`{mark}`")

    def _complaint(self, expected: str) -> BadPath:
        place = self._tokens[self._at][0] if self._at < len(self._tokens) else len(self._text)
        return BadPath(
            f"`path` cannot be read at character {place + 1}: {expected} is expected. It takes steps such as "
            '`//Device[@name="mixer"]//DataItem[@type="LOAD" and not(@name="x")]`, joined by `|`.'
        )


def _split(text: str) -> Iterator[tuple[int, str]]:
    """Give a path's tokens with where they begin."""
    at, end = 0, len(text.rstrip())
    while at < end:
        found = _TOKEN.match(text, at, end)
        if found is None:
            raise BadPath(f"`path` cannot be read at character {at + 1}: {text[at : at + 20]!r}.")
        yield found.start(1), found[1]
        at = found.end()
