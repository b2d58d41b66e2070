"""What the excepts of a try catch: kinds of failures, each in one of them."""

from __future__ import annotations

import ast

from editor.language.parsing.answers import closest
from editor.language.parsing.scope import Refused
from editor.language.tree.nodes import ERROR_CLASSES

_KINDS = {name: kind for kind, name in ERROR_CLASSES.items()}


def _kinds(handler: ast.ExceptHandler) -> tuple[str, ...]:
    classes = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    names = [node.id for node in classes if isinstance(node, ast.Name)]
    if names == ["TaskError"] and len(classes) == 1:
        return ()
    if len(names) != len(classes) or not names or not set(names) <= _KINDS.keys():
        near = next((closest(name, ["TaskError", *_KINDS]) for name in names if name not in _KINDS), "")
        instead = f"Catch TaskError, or some of: {', '.join(_KINDS)}."
        where, instead = handler.type or handler, f"Did you mean {near}? {instead}" if near else instead
        raise Refused(where, "What is caught here", instead)
    caught = {_KINDS[name] for name in names}
    return tuple(kind for kind in ERROR_CLASSES if kind in caught)


def kinds_of_all(handlers: list[ast.ExceptHandler]) -> list[tuple[str, ...]]:
    """Return what each except catches; one that comes too late for anything is refused."""
    kinds, caught = list(map(_kinds, handlers)), set[str]()
    for handler, each in zip(handlers, kinds, strict=True):
        wanted = {*(each or ERROR_CLASSES)}
        if wanted <= caught:
            raise Refused(
                handler, "An except that nothing comes to", "Leave it out: those before it catch all of that."
            )
        caught |= wanted
    return kinds


def kinds_together(kinds: list[tuple[str, ...]]) -> tuple[str, ...]:
    """Return the kinds of which one is meant by any of these; none where one of them means all."""
    named = {kind for each in kinds for kind in each}
    return tuple(kind for kind in ERROR_CLASSES if kind in named) if all(kinds) else ()
