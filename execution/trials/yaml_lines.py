"""YAML read with suspicion: no tags, no anchors, bounded, each value with the line where it stands."""

from __future__ import annotations

from typing import Any, Final

import yaml

from vipo_device.protocol.texts import find_unfit

MOST_BYTES: Final = 1_000_000
MOST_NODES: Final = 50_000
DEEPEST: Final = 20
LONGEST_NUMBER: Final = 40
"""Characters of a number; YAML knows forms that longer ones would take minutes in."""
Path = tuple[str | int, ...]
_PLAIN: Final = frozenset(f"tag:yaml.org,2002:{kind}" for kind in ("str", "int", "float", "bool", "null"))
_NUMBERS: Final = frozenset(("tag:yaml.org,2002:int", "tag:yaml.org,2002:float"))


class BadTrialFile(Exception):
    """A file of tests that cannot be read; `line` counts from 1, 0: unknown."""

    def __init__(self, line: int, why: str) -> None:
        super().__init__(why)
        self.line, self.why = line, why


class _Loader(yaml.SafeLoader):
    """SafeLoader without anchors and aliases, of which a few can stand for gigabytes, and without tags.

    A tag would make another value of what stands there than what one reads.
    """

    nodes = 0
    depth = 0

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        event = self.peek_event()  # type: ignore[no-untyped-call]  # PyYAML's types leave it out
        line = event.start_mark.line + 1
        if isinstance(event, yaml.AliasEvent) or getattr(event, "anchor", None):
            raise BadTrialFile(line, "It uses an anchor (&name) or an alias (*name). Write out what it stands for.")
        if getattr(event, "tag", None):
            raise BadTrialFile(line, "It uses a tag (such as !!str). Write the value alone, a text in quotes.")
        self.nodes += 1
        self.depth += 1
        if self.nodes > MOST_NODES:
            raise BadTrialFile(line, f"It holds more than {MOST_NODES} values. Split it into several files.")
        if self.depth > DEEPEST:
            raise BadTrialFile(line, f"It is nested deeper than {DEEPEST} levels. No test needs that.")
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node


def read_yaml(payload: bytes) -> tuple[Any, dict[Path, int]]:
    """Return what a file says and, for each path in it, its line; raises BadTrialFile."""
    if len(payload) > MOST_BYTES:
        raise BadTrialFile(0, f"It is larger than {MOST_BYTES // 1_000_000} MB. Split it into several files.")
    try:
        loader = _Loader(payload.decode("utf-8-sig"))
        node = loader.get_single_node()
        lines: dict[Path, int] = {}
        return (None if node is None else _plain(loader, node, (), lines)), lines
    except UnicodeDecodeError as error:
        raise BadTrialFile(0, "It is not text in UTF-8.") from error
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 0
        raise BadTrialFile(line, f"It is no YAML: {error.problem or error.context}.") from error
    except (yaml.YAMLError, ValueError) as error:
        raise BadTrialFile(0, f"It is no YAML: {str(error).splitlines()[0]}.") from error


def _plain(loader: _Loader, node: yaml.Node, path: Path, lines: dict[Path, int]) -> Any:
    lines[path] = node.start_mark.line + 1
    if isinstance(node, yaml.MappingNode):
        return _mapping(loader, node, path, lines)
    if isinstance(node, yaml.SequenceNode):
        return [_plain(loader, item, (*path, index), lines) for index, item in enumerate(node.value)]
    _refuse_unfit(node)
    if node.tag not in _PLAIN:
        return str(node.value)  # a date, and whatever else YAML would make of a text
    if node.tag in _NUMBERS and len(node.value) > LONGEST_NUMBER:
        line = node.start_mark.line + 1
        raise BadTrialFile(line, f"A number has at most {LONGEST_NUMBER} characters. Write it shorter.")
    return loader.construct_object(node)


def _refuse_unfit(node: yaml.Node) -> None:
    """Refuse what no text may hold: an escape in quotes can name such characters, too."""
    if character := find_unfit(str(node.value)):
        raise BadTrialFile(node.start_mark.line + 1, f"It is no YAML: U+{ord(character):04X} is no text; take it out.")


def _mapping(loader: _Loader, node: yaml.MappingNode, path: Path, lines: dict[Path, int]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key_node, value_node in node.value:
        line = key_node.start_mark.line + 1
        if not isinstance(key_node, yaml.ScalarNode):
            raise BadTrialFile(line, "A word before a colon must be plain text.")
        _refuse_unfit(key_node)
        key = str(key_node.value)
        if key in found:
            raise BadTrialFile(line, f"“{key}” stands here twice; keep one of the two.")
        found[key] = _plain(loader, value_node, (*path, key), lines)
        lines[*path, key] = line
    return found
