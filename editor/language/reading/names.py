"""The names that a document gives: its parameters, roles, functions and variables, and what the script calls them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from editor.language.constructs.table import fields_by_kind
from editor.language.document.outline import PROGRAM, Outline, mapping
from editor.language.expressions.declarations import normal_type
from editor.language.expressions.names import attribute_name, local_name, unique_name
from editor.language.expressions.nodes import Expression, Located, is_missing
from editor.language.expressions.values import Names, UnknownParameter, plain, read_value
from editor.language.tree.choice import ITSELF, foreign_part
from editor.language.tree.program import Function, Parameter, Role

DEFAULT_ROLE = "robot"
_SETTERS = fields_by_kind("variable")
"""The kinds of steps that set a variable, with the parameter that names it."""


def variables_by_root(outline: Outline) -> dict[str, set[str]]:
    """Return the names that are set in the program (its events, too) and in each function but no variables of loops.

    What is set in the program belongs to the program, also where a function sets it.
    """
    found: dict[str, set[str]] = {}
    setting = [(step, text_of(outline.params[step].get(_SETTERS[kind]))) for step, kind in outline.kinds.items()
               if kind in _SETTERS]  # fmt: skip
    if not any(name for _, name in setting):
        return found
    parents = {child: parent for (parent, _), steps in outline.children.items() for child in steps}
    for step, name in setting:
        root = _root_of(step, name, outline, parents) if name else None
        if root is not None:
            found.setdefault(root, set()).add(name)
    shared = found.get(PROGRAM, set())
    return {root: names if root == PROGRAM else names - shared for root, names in found.items()}


def _root_of(step: str, name: str, outline: Outline, parents: Mapping[str, str]) -> str | None:
    """Return the program or the function that a step belongs to; None for a draft, or for a loop's own variable."""
    here = parents.get(step)
    while here is not None and here in outline.kinds:
        if outline.kinds[here] == "for_each" and name in names_of_loop(outline.params[here]):
            return None
        here = parents.get(here)
    return here


def names_of_loop(params: Mapping[str, object]) -> tuple[str, ...]:
    """Return the names that a For-each gives to its item and to the number of the round."""
    return tuple(filter(None, (text_of(params.get("variable")), text_of(params.get("index")))))


def by_id(value: object) -> dict[str, Mapping[str, object]]:
    """Return the members of an object, sorted by their names."""
    return {name: mapping(item) for name, item in sorted(mapping(value).items(), key=lambda pair: str(pair[0])) if name}


def read_parameters(
    given: Iterable[tuple[str, Mapping[str, object]]], outside: Names | None = None
) -> tuple[tuple[Parameter, ...], dict[str, str]]:
    """Return the parameters, and their names in the document with those in the script.

    `outside` are the names that can be seen around a function; without them the parameters are the program's.
    """
    parameters: list[Parameter] = []
    names: dict[str, str] = {}
    for key, item in given:
        wanted = text_of(item.get("name")) or key
        if wanted and wanted not in names:
            if outside is None:
                names[wanted] = attribute_name(wanted, names.values())
            else:
                hidden = (script for name, script in {**outside, **names}.items() if name != wanted)
                names[wanted] = local_name(wanted, hidden)
            default, (kind, unit) = plain(item.get("default")), normal_type(item.get("type"), item.get("unit"))
            parameters.append(Parameter(names[wanted], default, kind, unit))
    return tuple(parameters), names


def read_roles(given: Mapping[str, Mapping[str, object]], taken: Iterable[str]) -> dict[str, Role]:
    """Return the roles by id, the default one among them; none of their names is one of the `taken`."""
    roles: dict[str, Role] = {}
    names = set(taken)
    for key, item in {DEFAULT_ROLE: given.get(DEFAULT_ROLE, {}), **given}.items():
        wanted = text_of(item.get("name")) if key != DEFAULT_ROLE else DEFAULT_ROLE
        name = attribute_name(wanted or key, names)
        names.add(name)
        device, can = item.get("device"), item.get("can")
        listed = can if isinstance(can, list | tuple) else ()
        methods = tuple(dict.fromkeys(method for method in listed if isinstance(method, str) and method))
        bound = device if isinstance(device, str) and device else None
        where, looks_elsewhere = (None, False) if bound else _read_choice(item.get("where"), key)
        can_do = () if bound else methods
        roles[key] = Role(name, bound, can_do, None, key, where=where, looks_elsewhere=looks_elsewhere)
    return roles


def _read_choice(value: object, role: str) -> tuple[Expression | None, bool]:
    """Return the condition by which a role's robot is chosen, and whether it speaks of anything else than the robot."""
    try:
        where = read_value(value, {}, lambda other: ITSELF if other == role else Located(role=other))
    except UnknownParameter:
        return None, True
    if foreign_part(where) is not None:
        return None, True
    return (None if is_missing(where) else where), False


def read_functions(given: Mapping[str, Mapping[str, object]], taken: Iterable[str]) -> dict[str, Function]:
    """Return the functions by id, still without parameters and bodies."""
    functions: dict[str, Function] = {}
    used = set(taken)
    for key, item in given.items():
        name = text_of(item.get("name")) or key
        method = unique_name(name, used)
        used.add(method)
        result = mapping(item.get("result"))
        functions[key] = Function(method, (), (), *normal_type(result.get("type"), result.get("unit")), key, name)
    return functions


def read_arguments(function: Mapping[str, object], names: Names) -> tuple[tuple[Parameter, ...], dict[str, str]]:
    """Return the parameters of a function around which these names can be seen, and what the script calls them."""
    listed = function.get("parameters")
    items = [("", mapping(entry)) for entry in listed] if isinstance(listed, list | tuple) else []
    return read_parameters(items, names)


def text_of(value: object) -> str:
    """Return a text, or an empty one for anything else."""
    return value if isinstance(value, str) else ""
