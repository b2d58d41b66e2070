"""The usage lines of docs/cli.md name the options that the commands have."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator

from tests.kit.files import ROOT
from vipo_site.cli.main import _parser
from vipo_site.cli.token import SCOPES


def commands_of(parser: argparse.ArgumentParser, name: str = "vipo") -> Iterator[tuple[str, set[str]]]:
    """Yield each command with its long options."""
    groups = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    for group in groups:
        words = {sub: word for word, sub in reversed(group.choices.items())}  # of several names the first
        for sub, word in words.items():
            yield from commands_of(sub, f"{name} {word}")
    if not groups:
        flags = {flag for action in parser._actions for flag in action.option_strings if flag.startswith("--")}
        yield name, flags - {"--help"}


def test_each_command_stands_in_the_page_with_its_options() -> None:
    page = (ROOT / "docs" / "cli.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"\A# .*?\n\n```\n(.*?)```", page, re.DOTALL)
    lines = [re.sub(r"(?<=\w) +", " ", line) for line in block.splitlines()]
    for name, options in commands_of(_parser()):
        said = " ".join(line for line in lines if f"{line} ".startswith(f"{name} ")).replace("-o FILE", "--output FILE")
        assert set(re.findall(r"--[a-z][a-z-]*", said)) == options, name


def test_the_page_names_what_a_token_may_do() -> None:
    page = (ROOT / "docs" / "cli.md").read_text(encoding="utf-8")
    assert f"[--scope {'|'.join(SCOPES)}]..." in page
