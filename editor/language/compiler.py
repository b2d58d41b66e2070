"""The compiler: a document read, checked, printed as a script and compiled to a plan, from one reading."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final

from editor.language.allocation import paused_collector
from editor.language.analysis.memo import Memo, Memos
from editor.language.analysis.positions import add_moves
from editor.language.checks.checks import check
from editor.language.document.format_migrations import migrate
from editor.language.messages.diagnostics import Diagnostic, Problem, diagnostic_to_json, put_into_words
from editor.language.plan.compiler import compile_tree
from editor.language.plan.instructions import Plan
from editor.language.printing.script import Script, print_tree
from editor.language.reading.document import ReadDocument, read_document
from editor.language.site.surroundings import Surroundings, standing_places
from editor.language.tree.nodes import COMPOSITES, Block, blocks_of
from editor.language.tree.nodes import Move as MoveNode
from editor.language.tree.numbering import number_steps, numbers_in_script
from editor.language.tree.program import Tree
from editor.language.tree.robots import with_crew, with_holds, with_roles_of_robots
from editor.language.tree.zones import zone_names
from vipo_device.protocol.description import Scalar

NOTHING_GIVEN: Final[Mapping[str, Scalar]] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class Compiled:
    """A program's forms. `lines` has the step of each script line ("" for glue); `plan` is None while there are errors.

    `numbers` and `order` follow the reading order; drafts stand last in `order` and have no number.
    """

    tree: Tree
    script: str
    lines: tuple[str, ...]
    numbers: Mapping[str, str]
    diagnostics: tuple[Diagnostic, ...]
    plan: Plan | None
    added_moves: tuple[str, ...]
    order: tuple[str, ...]
    depth: Mapping[str, int]


def compile_document(document: object, surroundings: Surroundings) -> Compiled:
    """Compile a document (plain JSON, of any format so far) for a site. Nothing in the document makes this raise."""
    with paused_collector():
        return look_at(document, surroundings).compiled()


@dataclass(frozen=True, slots=True)
class Look:
    """A document read and checked; how it is shown and carried out is worked out when it is asked for."""

    document: object
    surroundings: Surroundings
    reading: ReadDocument
    tree: Tree
    found: list[tuple[Problem, int]]
    """The problems, each with the identity of its node."""
    holds: Mapping[str, int]
    """Role → how many objects its robot may have to hold at once, where that is more than one."""
    printed: Memo | None

    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Return the problems in words, in reading order."""
        if not self.found:
            return ()
        numbers = numbers_in_script(self.tree)
        return _in_words(self.found, numbers, self._script(numbers))

    def compiled(self, *, with_plan: bool = True) -> Compiled:
        """Return all forms of the program; the plan may be left out."""
        tree, numbering = self.tree, number_steps(self.tree)
        numbers, script = numbering.numbers, self._script(numbering.numbers)
        diagnostics = _in_words(self.found, numbers, script)
        faulty = any(diagnostic.severity == "error" for diagnostic in diagnostics)
        plan = None
        if with_plan and not faulty:
            plan = compile_tree(with_holds(tree, self.holds), self.surroundings, script.line_of)
        outline = self.reading.outline
        drafts = outline.with_inner((*outline.drafts, *outline.unknown))
        order = (*numbers, *drafts)
        depth = {**{step: numbering.depths[step] for step in numbers}, **drafts}
        added = _added_moves(tree)
        return Compiled(tree, script.text, script.lines, numbers, diagnostics, plan, added, order, depth)

    def _script(self, numbers: Mapping[str, str]) -> Script:
        return print_tree(self.tree, self.surroundings, numbers, zone_names(self.document), self.printed)


def look_at(
    document: object,
    surroundings: Surroundings,
    memos: Memos | None = None,
    given: Mapping[str, Scalar] = NOTHING_GIVEN,
) -> Look:
    """Read and check a document; what the memos hold of the last look is used, and they then hold this one.

    `given` is what a run gives the parameters, by their names in the script; of the others nothing is known.
    """
    reading = read_document(migrate(document), memos.read if memos else None)
    tree = with_roles_of_robots(reading.tree, surroundings)
    if given:
        tree = replace(tree, parameters=tuple(replace(each, given=given.get(each.name)) for each in tree.parameters))
    tree = add_moves(tree, standing_places(surroundings), memos.positions if memos else None)
    surroundings = with_crew(surroundings, tree.roles)
    found, holds = check(reading, tree, surroundings, document, memos)
    return Look(document, surroundings, reading, tree, found, holds, memos.printed if memos else None)


def _added_moves(tree: Tree) -> tuple[str, ...]:
    found: dict[str, None] = {}
    left: list[Block] = [tree.body, *(f.body for f in tree.functions), *(event.body for event in tree.events)]
    for block in left:
        for node in block:
            if isinstance(node, MoveNode):
                if node.added:
                    found[node.step] = None
            elif node.__class__ in COMPOSITES:
                left.extend(inner for inner in blocks_of(node) if inner)
    return tuple(found)


def _in_words(
    problems: list[tuple[Problem, int]], numbers: Mapping[str, str], script: Script
) -> tuple[Diagnostic, ...]:
    """Put problems into words, in reading order; each stands at its node's line, or at its step's first."""
    if not problems:
        return ()
    places = {step: index for index, step in enumerate(numbers)}
    elsewhere = {problem.step for problem, node in problems if node not in script.line_of} - {""}
    first_lines: dict[str, int] = {}
    for line, step in enumerate(script.lines, start=1) if elsewhere else ():
        if step in elsewhere:
            first_lines.setdefault(step, line)
    unique: dict[tuple[str, str, str], tuple[tuple[int, str, int], Diagnostic]] = {}
    for index, (problem, node) in enumerate(problems):
        shown: int | None = script.line_of.get(node) or first_lines.get(problem.step)
        key = (places.get(problem.step, len(places)), problem.step, index)
        unique.setdefault((problem.code, problem.step, problem.field), (key, put_into_words(problem, shown)))
    return tuple(diagnostic for _, diagnostic in sorted(unique.values(), key=lambda pair: pair[0]))


def compiled_to_json(compiled: Compiled, revision: int = 0) -> dict[str, object]:
    """Return the form that goes to browsers, sockets and `vipo … --json`, as docs/shapes/compiled.md has it."""
    return {
        "revision": revision,
        "script": compiled.script,
        "lines": list(compiled.lines),
        "numbers": dict(compiled.numbers),
        "diagnostics": [diagnostic_to_json(diagnostic) for diagnostic in compiled.diagnostics],
        "added_moves": list(compiled.added_moves),
        "order": list(compiled.order),
        "depth": dict(compiled.depth),
    }


class EditedProgram:
    """One program, looked at again and again; it says of each document just what `compile_document` says.

    Documents are plain JSON and are not changed in place: a step that is the same object as at the last look is
    the same step. What is remembered is no more than what the last look needed. Not to be used from two threads
    at once.
    """

    def __init__(self) -> None:
        """Know nothing yet."""
        self._memories = Memos()

    def look(self, document: object, surroundings: Surroundings) -> Look:
        """Read and check the document as it is now."""
        return look_at(document, surroundings, self._memories)

    def compile(self, document: object, surroundings: Surroundings) -> Compiled:
        """Return all forms of the program as it is now."""
        return self.look(document, surroundings).compiled()
