"""Checks of functions that came from the library: whether their version is there, and whether it is the newest."""

from __future__ import annotations

from collections.abc import Iterator

from editor.language.checks.context import Context
from editor.language.document.outline import mapping
from editor.language.messages.diagnostics import Fix, TextArguments
from editor.language.messages.phrases import Options
from editor.language.signatures.compatibility import breaks
from editor.language.site.surroundings import LibraryFacts
from editor.language.tree import nodes as n
from editor.language.tree.nodes import walk
from editor.language.tree.program import Function, Tree


def check_library(context: Context, document: object) -> None:
    """Check every function of the document that names a version of the library; reported where it is called first."""
    library = context.surroundings.library
    if library is None:
        return
    by_id = {function.id: function for function in context.tree.functions}
    for name, source, version in _sources(document):
        function = by_id.get(name)
        step = None if function is None else _where(context.tree, function)
        facts = library.get(source)  # of what this site does not see nothing is said: it may be there or gone
        if function is not None and step and facts is not None:
            _check_version(context, function, step, (source, version), facts)


def _sources(document: object) -> Iterator[tuple[str, str, int]]:
    functions = mapping(mapping(document).get("functions"))
    for name in sorted(functions, key=str):
        source = mapping(mapping(functions[name]).get("source"))
        library, version = source.get("library"), source.get("version")
        if isinstance(library, str) and isinstance(version, int) and not isinstance(version, bool):
            yield str(name), library, version


def _where(tree: Tree, function: Function) -> str:
    """Return the step where a function is called first, else its own first step."""
    for block in (tree.body, *(event.body for event in tree.events), *(f.body for f in tree.functions)):
        for node in walk(block):
            if isinstance(node, n.Call) and node.function == function.method:
                return node.step
    return function.body[0].step if function.body else ""


def _check_version(
    context: Context, function: Function, step: str, source: tuple[str, int], facts: LibraryFacts
) -> None:
    library, version = source
    name: TextArguments = {"function": function.name or function.method, "version": version}
    if version not in facts.versions:
        context.report_step(step, "version_gone", "source", name)
        return
    newest = max(facts.versions)
    if newest == version:
        return
    value = {"function": function.id, "library": library, "version": newest}
    fix = Fix("use_version", step, "source.version", value, {"value": newest})
    if not breaks(facts.versions[version], facts.versions[newest]):
        context.report_step(step, "newer_version", "source", {**name, "newest": newest}, fix)
    else:
        takes = Options(tuple(port.name for port in facts.versions[newest].parameters))
        context.report_step(step, "signature_changed", "source", {**name, "newest": newest, "parameters": takes}, fix)
