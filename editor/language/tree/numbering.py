"""The numbers that people see: 1, 1a, 1b.1, 4c; the same on the map, in the script and in the log.

A step of the program has its place in the order. Inside a step each branch has a letter; the only step of a
branch bears just the letter (4a), several are counted after it (6a.1, 6a.2). The steps of a function are
counted behind the number of its first call (1b.1), or behind f1, f2 … where nobody calls it, or that call lies too
deep in others. Events are e1, e2 …, their steps e1.1, e1.2 ….
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Set
from dataclasses import dataclass, field
from string import ascii_lowercase

from editor.language.document.outline import DEEPEST_STEP
from editor.language.tree.nodes import COMPOSITES, Block, Call, Node, Parallel, Try, blocks_of
from editor.language.tree.program import Tree

_MORE = COMPOSITES | {Call}
"""The nodes by which other steps get their numbers."""
_OF_CATCHES = "cdeghijk"
"""The letters of a Try's catches; its final part is f, as it always was."""
_BEFORE_FINAL = _OF_CATCHES.index("g")
_PARTS = re.compile(r"[0-9]+|[a-z]")


def letters_of(node: Node) -> Iterator[tuple[str, Block]]:
    """Yield the branches of a node with their letters."""
    if isinstance(node, Try):
        yield from (("a", node.body), *zip(_OF_CATCHES, node.catches, strict=False), ("f", node.final))
    else:
        yield from zip(ascii_lowercase, blocks_of(node), strict=False)


@dataclass(slots=True)
class Numbering:
    """The number and the depth of every step, in reading order."""

    numbers: dict[str, str] = field(default_factory=dict)
    depths: dict[str, int] = field(default_factory=dict)
    first_calls: dict[str, tuple[str, int]] = field(default_factory=dict)
    """Function → the number and the depth of its first call."""
    late: set[str] = field(default_factory=set)
    """The numbers of final parts that are read behind catches with later letters."""

    def block(self, block: Block, prefix: str, depth: int) -> None:
        """Number the steps of a block; a step of several nodes counts once."""
        count, numbers, depths = 0, self.numbers, self.depths
        for node in block:
            step = node.step
            if step not in numbers:
                count += 1
                if node.__class__ in _MORE:
                    self.node(node, f"{prefix}{count}", depth)
                else:
                    numbers[step], depths[step] = f"{prefix}{count}", depth

    def node(self, node: Node, number: str, depth: int) -> None:
        """Number one step and what stands in it."""
        self.numbers[node.step], self.depths[node.step] = number, depth
        if isinstance(node, Call) and node.function:
            self.first_calls.setdefault(node.function, (number, depth))
        if node.__class__ not in COMPOSITES:
            return
        if isinstance(node, Try) and len(node.handlers) > _BEFORE_FINAL:
            self.late.add(f"{number}f")
        for letter, block in letters_of(node):
            if block and block[0].step == block[-1].step:
                self.node(block[0], f"{number}{letter}", depth + 1)
            else:
                self.block(block, f"{number}{letter}.", depth + 1)


def number_steps(tree: Tree) -> Numbering:
    """Return the numbers of a tree's steps; a function's steps stand behind its first call, or last of all."""
    numbering = Numbering()
    numbering.block(tree.body, "", 0)
    for index, event in enumerate(tree.events, start=1):
        numbering.numbers[event.step], numbering.depths[event.step] = f"e{index}", 0
        numbering.block(event.body, f"e{index}.", 1)
    uncalled = 0
    for function in tree.functions:
        number, depth = numbering.first_calls.get(function.method, ("", -1))
        if not number or depth >= DEEPEST_STEP:  # numbers behind numbers would grow with every call in a long chain
            depth = -1
            uncalled += 1
            number = f"f{uncalled}"
        numbering.block(function.body, f"{number}.", depth + 1)
    if tree.functions:
        ordered = sorted(numbering.numbers.items(), key=lambda pair: _reading_key(pair[1], numbering.late))
        numbering.numbers = dict(ordered)
    return numbering


def numbers_in_script(tree: Tree) -> dict[str, str]:
    """Return the steps in reading order, with their numbers where the script calls anything by them."""
    if tree.events or tree.functions or tree.holds(Parallel):
        return number_steps(tree).numbers
    return dict.fromkeys([node.step for node in tree.walked(tree.body)], "")


def _reading_key(number: str, late: Set[str]) -> list[tuple[int, str]]:
    """Sort 2 before 10, 1b before 1b.1, events behind the program, the functions that nobody calls last."""
    parts = list(_PARTS.finditer(number))
    key = [(int(part[0]), "") if part[0].isdigit() else (0, _letter(number[: part.end()], late)) for part in parts]
    return [({"e": 1, "f": 2}.get(parts[0][0], 0), ""), *key]


def _letter(number: str, late: Set[str]) -> str:
    return "z" if number in late else number[-1]
