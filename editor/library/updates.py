"""Functions of the library that a program holds, as another version has them, without writing into the program."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Set
from dataclasses import replace
from typing import Any
from uuid import UUID, uuid4

from editor.documents.shared_document import digest_of
from editor.errors import BadRequest
from editor.language.reading.well_formed import well_formed
from editor.library.function_extraction import Bodies, called_by, held_by
from editor.library.queries import get_definitions, get_function
from editor.programs.contents import ContentView, get_content

MakeId = Callable[[], str]
Former = Mapping[int, Mapping[str, Any]]
_NAMING = ("function", "role", "zone")
BODY = ("program", "body")
_ABOVE_M = 1.2


def get_updated_content(*, program_id: UUID, library: UUID, version: int, user: Any) -> ContentView:
    """Return what a program would hold with a library function, which it has already, at another version.

    Raises:
        NoSuchProgram: there is no such program, or no such function or version that this person sees.
        BadRequest: the program does not hold the function.
        UnreadableVersion, DocumentHole: as for any content.
    """
    content = get_content(program_id=program_id)
    wanted = get_function(function_id=library, user=user, version=version)
    held = {number for function, number in held_by(content.document) if function == str(library)}
    former = get_definitions(function_id=library, user=user, versions=held)
    source = (str(library), version)
    document = with_version(content.document, wanted.definition, source, lambda: uuid4().hex, former)
    return replace(content, document=document, digest=digest_of(document))


def with_version(
    document: Mapping[str, Any], cut: Mapping[str, Any], source: tuple[str, int], make_id: MakeId, former: Former
) -> dict[str, Any]:
    """Return a document with all functions of a library's function as `cut` has it; calls of them stay.

    The functions go that came with the version that the document holds, by their names there, and that nothing else
    calls. `former` are such versions by number; of one that is not among them the names in `cut` count.

    Raises BadRequest if the document holds none.
    """
    document = well_formed(document)
    held = [name for name, each in document["functions"].items() if _library_of(each) == source[0]]
    if not held:
        raise BadRequest("The program does not hold this function of the library. It may have been deleted from it.")
    for function in held:
        if each := document["functions"].get(function):  # it may have gone with another that alone called it
            _replace(document, function, cut, source, _former(each, cut, former), make_id)
    return document


def _library_of(function: Mapping[str, Any]) -> object:
    source = function.get("source")
    return source.get("library") if isinstance(source, Mapping) else None


def _former(held: Mapping[str, Any], cut: Mapping[str, Any], former: Former) -> Mapping[str, Any]:
    """Return the version that a program holds, or the new one where nobody knows that."""
    number = held["source"].get("version")
    return former.get(number, cut) if isinstance(number, int) else cut


def _names_in(version: Mapping[str, Any]) -> set[object]:
    return {each.get("name") for each in version["functions"].values()}


def _replace(
    document: dict[str, Any],
    function: str,
    cut: Mapping[str, Any],
    source: tuple[str, int],
    former: Mapping[str, Any],
    make_id: MakeId,
) -> None:
    bodies = Bodies(document["steps"])
    old = _parts_of_only(document, bodies, function, _names_in(former))
    for step in bodies.reach([function, *old])[1]:
        del document["steps"][step]
    for part in old:
        del document["functions"][part]
    fresh = {str(cut["id"]): function} | {each: make_id() for each in (*cut["functions"], *cut["steps"])}
    named = {root: cut.get(root) or {} for root in ("roles", "zones")}
    others = [(root, name) for root, all_ in named.items() for name in all_ if document[root].get(name) != all_[name]]
    fresh |= {name: make_id() for root, name in others if name in document[root]}
    for root, name in others:  # a role may name itself
        document[root][fresh.get(name, name)] = _renamed(named[root][name], fresh)
    document["functions"][function] = {**cut["function"], "source": {"library": source[0], "version": source[1]}}
    document["functions"] |= {fresh[name]: value for name, value in cut["functions"].items()}
    document["steps"] |= {fresh[name]: _renamed_step(step, fresh) for name, step in cut["steps"].items()}


def _parts_of_only(document: Mapping[str, Any], bodies: Bodies, function: str, names: Set[object]) -> set[str]:
    """Return the functions of these names that a function calls, itself or by others, and that nothing else calls."""
    functions, steps = document["functions"], document["steps"]
    called, _ = bodies.reach([function], functions)
    parts = {each for each in called if each != function and functions[each].get("name") in names}
    _, inside = bodies.reach([function, *parts])
    elsewhere = {called_by(steps[step]) for step in steps.keys() - inside.keys()}
    kept, _ = bodies.reach([each for each in parts if each in elsewhere], parts)
    return parts.difference(kept)


def _renamed_step(step: Mapping[str, Any], fresh: Mapping[str, str]) -> dict[str, Any]:
    place = step.get("place")
    placed = [fresh.get(place[0], place[0]), *place[1:]] if place else None
    return {**step, "place": placed, "params": _renamed(step["params"], fresh)}


def _renamed(value: Any, fresh: Mapping[str, str], key: str = "") -> Any:
    if isinstance(value, Mapping):
        return {name: _renamed(each, fresh, name) for name, each in value.items()}
    if isinstance(value, list):
        return [_renamed(each, fresh) for each in value]
    return fresh.get(value, value) if key in _NAMING and isinstance(value, str) else value


def body_as_program(definition: Mapping[str, Any]) -> dict[str, Any]:
    """Return a document whose program is the body of a library function, so that it can be drawn on a map.

    Its steps keep their ids; it begins above its first one. Parameters of the function are those of the program.
    """
    name, function = str(definition["id"]), definition["function"]
    steps = {each: _as_outer(step, name) for each, step in definition["steps"].items()}
    outer = [step for step in steps.values() if step.get("place") and tuple(step["place"][:2]) == BODY]
    first = min(outer, key=lambda step: str(step["place"][2]), default=None)
    start = {"start_pos": [first["pos"][0], first["pos"][1] + _ABOVE_M]} if first and first.get("pos") else {}
    parameters = {str(each["name"]): dict(each) for each in function.get("parameters") or () if each.get("name")}
    kept = {root: definition.get(root) or {} for root in ("functions", "roles", "zones")}
    return well_formed({"format": definition.get("format"), **start, **kept, "steps": steps, "parameters": parameters})


def _as_outer(step: Mapping[str, Any], function: str) -> dict[str, Any]:
    place = step.get("place")
    return {**step, "place": [*BODY, *place[2:]]} if place and place[0] == function else dict(step)
