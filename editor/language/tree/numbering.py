"""The numbers that people see: 1, 1a, 1b.1, 4c; the same on the map, in the script and in the log.

A step of the program has its place in the order. Inside a step each branch has a letter; the only step of a
branch bears just the letter (4a), several are counted after it (6a.1, 6a.2). The steps of a function are
counted behind the number of its first call (1b.1), or behind f1, f2 … where nobody calls it, or that call lies too
deep in others. Events are e1, e2 …, their steps e1.1, e1.2 ….
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from string import ascii_lowercase

from editor.language.document.outline import DEEPEST_STEP
from editor.language.tree.nodes import COMPOSITES, Block, Call, Node, Parallel, Try, blocks_of
from editor.language.tree.program import Tree

_MORE = COMPOSITES | {Call}
"""The nodes by which other steps get their numbers."""
_OF_CATCHES = "cdeghijk"
"""The letters of a Try's catches; its final part is f, as it always was."""


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
    first_calls: dict[str, tuple[str, str, int]] = field(default_factory=dict)
    """Function → the step, the number and the depth of its first call."""

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
            self.first_calls.setdefault(node.function, (node.step, number, depth))
        if node.__class__ not in COMPOSITES:
            return
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
    if tree.functions:
        _number_functions(tree, numbering)
    return numbering


def _number_functions(tree: Tree, numbering: Numbering) -> None:
    """Number the steps of the functions, and put them behind the first call, or last of all."""
    parts = [numbering.numbers]
    called: dict[str, dict[str, str]] = {}
    for function in tree.functions:
        step, number, depth = numbering.first_calls.get(function.method, ("", "", -1))
        numbering.numbers = {}
        if not number or depth >= DEEPEST_STEP:  # numbers behind numbers would grow with every call in a long chain
            parts.append(numbering.numbers)
            numbering.block(function.body, f"f{len(parts) - 1}.", 0)
        else:
            called[step] = numbering.numbers
            numbering.block(function.body, f"{number}.", depth + 1)
    numbering.numbers = dict(pair for part in parts for pair in _with_called(part, called))


def _with_called(part: Mapping[str, str], called: Mapping[str, Mapping[str, str]]) -> Iterator[tuple[str, str]]:
    """Yield steps with their numbers, behind a first call those of its function."""
    left = [iter(part.items())]
    while left:
        for step, number in left[-1]:
            yield step, number
            if step in called:
                left.append(iter(called[step].items()))
                break
        else:
            left.pop()


def numbers_in_script(tree: Tree) -> dict[str, str]:
    """Return the steps in reading order, with their numbers where the script calls anything by them."""
    if tree.events or tree.functions or tree.holds(Parallel):
        return number_steps(tree).numbers
    return dict.fromkeys([node.step for node in tree.walked(tree.body)], "")
