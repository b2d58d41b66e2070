"""Document → tree: what people drew, read into typed nodes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from editor.language.analysis.memo import ReadMemo
from editor.language.document.format_migrations import FORMAT, format_of
from editor.language.document.outline import EVENTS, PROGRAM, Outline, make_outline
from editor.language.expressions.names import RESERVED_ATTRIBUTES, attribute_name, local_name
from editor.language.expressions.values import Names
from editor.language.messages.diagnostics import Fix, Problem
from editor.language.reading.names import (
    by_id,
    read_arguments,
    read_functions,
    read_parameters,
    read_roles,
    variables_by_root,
)
from editor.language.reading.reader import Reader
from editor.language.reading.steps import READERS
from editor.language.reading.well_formed import START, Odd, well_formed_parts
from editor.language.tree.nodes import Event
from editor.language.tree.program import Function, Tree
from editor.language.tree.traversal import in_reading_order
from editor.language.tree.zones import read_zones


@dataclass(frozen=True, slots=True)
class ReadDocument:
    """A document as it was read: the tree without added moves, and what could not be read."""

    tree: Tree
    outline: Outline
    problems: tuple[Problem, ...]


def read_document(document: object, memo: ReadMemo | None = None) -> ReadDocument:
    """Read a document (plain JSON, format 2); nothing in it makes this raise.

    `memo` has the steps as they were read last, and has them as they are read now.
    """
    whole, odd = well_formed_parts(document)
    outline = make_outline(whole) if memo is None else memo.last.look(whole)
    parameters, names = read_parameters(by_id(whole.get("parameters")).items())
    taken = {*RESERVED_ATTRIBUTES, *names.values()}
    roles = read_roles(by_id(whole.get("roles")), taken)
    taken |= {role.name for role in roles.values()}
    given = by_id(whole.get("functions"))
    functions = read_functions(given, taken)
    taken |= {function.method for function in functions.values()}
    variables = variables_by_root(outline)
    for name in sorted(variables.get(PROGRAM, ())):
        if name not in names:
            names[name] = attribute_name(name, taken)
            taken.add(names[name])
    reader = Reader(outline, roles, functions, {}, names, READERS, memo=memo)
    for key, function in functions.items():
        listed, reader.argument_names[key] = read_arguments(given[key], names)
        functions[key] = replace(function, parameters=listed)
    if memo is not None:
        memo.begin(outline, (roles, [(f.id, f.name, f) for f in functions.values()], reader.argument_names))
    body, events = reader.block(PROGRAM, "body"), _read_events(reader)
    finished = [_with_body(reader, function, names, variables.get(key, ())) for key, function in functions.items()]
    tree = in_reading_order(Tree(body, tuple(finished), tuple(roles.values()), parameters, events, read_zones(whole)))
    if format_of(document) > FORMAT:
        reader.problems.append(Problem("newer_format", "", "format", {"format": format_of(document)}))
    reader.problems.extend(map(_problem_of, odd))
    return ReadDocument(tree, outline, tuple(reader.problems))


def _problem_of(odd: Odd) -> Problem:
    if odd.root == START:
        return Problem("odd_position", "", START)
    fix = Fix("take_out", "", "part", {"root": odd.root, "part": odd.part}) if odd.part else None
    return Problem("odd_shape", "", odd.path, {"part": odd.path}, fix)


def _read_events(reader: Reader) -> tuple[Event, ...]:
    """Return the second entries; none of them sees what a function or a loop calls its own."""
    events: list[Event] = []
    for step in reader.outline.children.get((PROGRAM, EVENTS), ()):
        params = reader.outline.params[step]
        starts = "run" if params.get("starts") == "run" else "branch"
        condition = reader.value(step, params, "condition")
        events.append(Event(condition, reader.block(step, "body"), starts, step))
    return tuple(events)


def _with_body(reader: Reader, function: Function, names: Names, variables: Iterable[str]) -> Function:
    """Return a function with its steps, which see its parameters and its own variables before the program's."""
    if function.id in reader.outline.kinds:
        return function
    seen = {**names, **reader.argument_names[function.id]}
    for name in sorted(variables):
        if name not in reader.argument_names[function.id]:
            seen[name] = local_name(name, (script for other, script in seen.items() if other != name))
    reader.names = seen
    return replace(function, body=reader.block(function.id, "body"))
