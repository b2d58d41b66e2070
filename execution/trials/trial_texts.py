"""Files of tests taken apart into the texts of their tests, and put together of such; comments stay where they are."""

from __future__ import annotations

from collections.abc import Sequence

import yaml

from execution.trials.trial_file import VERSION, read_trials


def take_apart(payload: bytes) -> list[str]:
    """Return the text of each test of a file; raises BadTrialFile for what is no file of tests."""
    read_trials(payload)  # nothing that it refuses is taken apart
    text = payload.decode("utf-8-sig")
    root = yaml.compose(text, Loader=yaml.SafeLoader)
    assert isinstance(root, yaml.MappingNode)
    tests = next(value for key, value in root.value if key.value == "tests")
    return [_cut(text, node) for node in tests.value]


def _cut(text: str, node: yaml.Node) -> str:
    """Return what stands in a file between a value's ends, as if it stood at the beginning of its lines."""
    first, *rest = text[node.start_mark.index : node.end_mark.index].rstrip().splitlines()
    indent = " " * node.start_mark.column
    return "\n".join([first, *(line.removeprefix(indent) for line in rest)]) + "\n"


def put_together(program: str, texts: Sequence[str]) -> str:
    """Return a file of tests of a program, whose path is seen from the file."""
    quoted = yaml.safe_dump(program, allow_unicode=True, width=10_000).removesuffix("...\n").strip()
    tests = "".join(_entry(text) for text in texts)
    return f"version: {VERSION}\nprogram: {quoted}\n" + (f"tests:\n{tests}" if tests else "tests: []\n")


def _entry(text: str) -> str:
    """Return a text as an entry of a list; a line that is empty stays so."""
    lines = text.rstrip().splitlines()
    head = next((number for number, line in enumerate(lines) if line.strip() and not line.startswith("#")), 0)
    before = [f"  {line}".rstrip() for line in lines[:head]]
    body = [f"    {line}".rstrip() for line in lines[head:]]
    return "\n".join([*before, f"  - {body[0][4:]}", *body[1:]]) + "\n"
