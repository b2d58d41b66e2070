"""The spatial language: document → tree → script → plan, and back; with the checks. Pure.

`compile_document` is all that most callers need; `compiled_to_json` gives its form for browsers and the command line.
"""

from editor.language.compiler import Compiled, compile_document, compiled_to_json
from editor.language.drawing.document import tree_to_document
from editor.language.messages.diagnostics import Diagnostic, Fix
from editor.language.misfits import Misfit, find_misfit
from editor.language.parsing.script import Parsed, parse_script
from editor.language.plan.instructions import Plan
from editor.language.plan.json_form import UnreadablePlan, plan_from_json, plan_to_json
from editor.language.site.json_form import UnreadableSite, surroundings_from_json, surroundings_to_json
from editor.language.site.surroundings import DeviceFacts, FloorFacts, PlaceFacts, Surroundings, ZoneFacts
from editor.language.tree.program import Tree

__all__ = [
    "Compiled",
    "DeviceFacts",
    "Diagnostic",
    "Fix",
    "FloorFacts",
    "Misfit",
    "Parsed",
    "PlaceFacts",
    "Plan",
    "Surroundings",
    "Tree",
    "UnreadablePlan",
    "UnreadableSite",
    "ZoneFacts",
    "compile_document",
    "compiled_to_json",
    "find_misfit",
    "parse_script",
    "plan_from_json",
    "plan_to_json",
    "surroundings_from_json",
    "surroundings_to_json",
    "tree_to_document",
]
