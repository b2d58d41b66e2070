"""The excepts of a try: what each of them catches."""

from __future__ import annotations

import ast
from collections.abc import Callable

from editor.language.document.catches import MOST_CATCHES
from editor.language.parsing.answers import closest
from editor.language.parsing.scope import Refused
from editor.language.tree.nodes import ERROR_CLASSES, Block, Catch

_TOO_MANY = f"A try takes up to {MOST_CATCHES}. Let one of them catch several kinds: except (Offline, TimedOut):"
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


def parse_excepts(handlers: list[ast.ExceptHandler], block: Callable[[ast.ExceptHandler], Block]) -> tuple[Catch, ...]:
    """Return the catches that the excepts of a try are; `block` gives the steps of one."""
    if len(handlers) > MOST_CATCHES:
        raise Refused(handlers[MOST_CATCHES], "A further except", _TOO_MANY)
    return tuple(Catch(_kinds(handler), block(handler)) for handler in handlers)
