"""Nodes of the tree → lines of the script, by the records of constructs."""

from __future__ import annotations

from collections.abc import Mapping

from editor.language.constructs.script_form import CALLS
from editor.language.expressions.names import member_name
from editor.language.expressions.nodes import PROBLEM, PlaceRef
from editor.language.expressions.printing import quote
from editor.language.printing.fields import Prints, printer_of
from editor.language.printing.writer import Printer
from editor.language.tree.nodes import (
    ERROR_CLASSES,
    NODES,
    Break,
    Call,
    Continue,
    Fail,
    ForEach,
    If,
    Limit,
    Node,
    Operate,
    Parallel,
    Perform,
    Repeat,
    Return,
    Set,
    Try,
    While,
)
from editor.language.tree.numbering import letters_of
from editor.language.tree.variables import reads_problem
from vipo_device.protocol.description import MethodSpec


def _operate(printer: Printer, node: Operate, depth: int) -> None:
    device = node.device
    if device.device is not None:
        target = printer.device(device.device)
    elif device.value is not None:
        target = printer.value(device.value)
    else:
        target = "None" if device == PlaceRef() else printer.place(device).removesuffix(".location")
    printer.line(depth, f"{target}.{_order(printer, node)}", node.step)


def _order(printer: Printer, node: Operate) -> str:
    """Return `cure_paint(10)`, or the long form where the device's description does not say enough."""
    given = dict(node.arguments)
    facts = printer.surroundings.devices.get(node.device.device or "")
    method = facts.description.method(node.method) if facts else None
    if facts is not None and method is not None and given.keys() <= {p.name for p in method.parameters}:
        key = (facts.description.id, node.method)
        if key not in printer.method_names:
            printer.method_names[key] = member_name(node.method, [m.name for m in facts.description.methods])
        member = printer.method_names[key]
        if member:
            return f"{member}({_ordered(printer, method, node)})"
    return _long_order(printer, node)


def _ordered(printer: Printer, method: MethodSpec, node: Operate | Perform) -> str:
    """Return the arguments in the order of the method's parameters; what is left out at the end needs no None."""
    given = dict(node.arguments)
    ordered = [given.get(parameter.name) for parameter in method.parameters]
    while ordered and ordered[-1] is None and not method.parameters[len(ordered) - 1].required:
        ordered.pop()
    return ", ".join("None" if value is None else printer.value(value) for value in ordered)


def _long_order(printer: Printer, node: Operate | Perform) -> str:
    name = quote(node.method) if node.method else "None"
    arguments = ", ".join(f"{quote(key)}: {printer.value(value)}" for key, value in node.arguments)
    return f"operate({name}, {{{arguments}}})" if arguments else f"operate({name})"


def _perform(printer: Printer, node: Perform, depth: int) -> None:
    printer.line(depth, f"self.{node.role}.{_own_order(printer, node)}", node.step)


def _own_order(printer: Printer, node: Perform) -> str:
    """Return `honk(5)`, or the long form where the robots' descriptions do not say enough."""
    member, method = printer.own_method(node.role, node.method)
    if member is None or method is None or any(method.parameter(name) is None for name, _ in node.arguments):
        return _long_order(printer, node)
    return f"{member}({_ordered(printer, method, node)})"


def _if(printer: Printer, node: If, depth: int) -> None:
    printer.line(depth, f"if {printer.value(node.condition)}:", node.step)
    printer.block(node.then, depth + 1)
    if node.otherwise:
        printer.line(depth, "else:", node.step)
        printer.block(node.otherwise, depth + 1)


def _while(printer: Printer, node: While, depth: int) -> None:
    printer.line(depth, f"while {printer.value(node.condition)}:", node.step)
    printer.block(node.body, depth + 1)


def _parallel(printer: Printer, node: Parallel, depth: int) -> None:
    number = printer.numbers[node.step].replace(".", "_")
    names = [(f"branch_{number}{letter}", printer.locals, block) for letter, block in letters_of(node)]
    printer.branches.extend(names)
    references = [f"self.{name}" for name, _, _ in names]
    handed_on = [f"{name}={name}" for name in printer.locals]
    needed = [] if node.needed is None else [f"needed={node.needed}"]
    printer.line(depth, f"self.parallel({', '.join([*references, *needed, *handed_on])})", node.step)


def _try(printer: Printer, node: Try, depth: int) -> None:
    printer.line(depth, "try:", node.step)
    printer.block(node.body, depth + 1)
    for handler in node.handlers:
        classes = [ERROR_CLASSES[kind] for kind in handler.kinds] or ["TaskError"]
        caught = classes[0] if len(classes) == 1 else f"({', '.join(classes)})"
        printer.line(depth, f"except {caught} as problem:", node.step)
        outside = printer.locals
        if reads_problem(handler) and PROBLEM not in outside:
            printer.locals = (*outside, PROBLEM)
        printer.block(handler.block, depth + 1)
        printer.locals = outside
    if node.final or not node.handlers:
        printer.line(depth, "finally:", node.step)
        printer.block(node.final, depth + 1)


def _limit(printer: Printer, node: Limit, depth: int) -> None:
    printer.line(depth, f"with self.limit({printer.value(node.seconds)}):", node.step)
    printer.block(node.body, depth + 1)


def _call(printer: Printer, node: Call, depth: int) -> None:
    arguments = ", ".join(f"{name}={printer.value(value)}" for name, value in node.arguments)
    text = f"self.{node.function}({arguments})" if node.function else "self.call(None)"
    taken = f"{printer.variable(node.result)} = " if node.result else ""
    printer.line(depth, taken + text, node.step)


def _repeat(printer: Printer, node: Repeat, depth: int) -> None:
    printer.line(depth, f"for _ in range({printer.value(node.times)}):", node.step)
    printer.block(node.body, depth + 1)


def _for_each(printer: Printer, node: ForEach, depth: int) -> None:
    items = ", ".join(map(printer.value, node.items))
    name, listed = node.variable or "_", f"[{items}]" if node.over is None else printer.value(node.over)
    head = f"for {node.index}, {name} in enumerate({listed}, 1):" if node.index else f"for {name} in {listed}:"
    printer.line(depth, head, node.step)
    outside = printer.locals
    printer.locals = (*outside, *(each for each in node.names if each not in outside))
    printer.block(node.body, depth + 1)
    printer.locals = outside


def _set(printer: Printer, node: Set, depth: int) -> None:
    value = printer.value(node.value)
    text = f"{printer.variable(node.variable)} = {value}" if node.variable else f"self.set(None, {value})"
    printer.line(depth, text, node.step)


def _return(printer: Printer, node: Return, depth: int) -> None:
    printer.line(depth, "return" if node.value is None else f"return {printer.value(node.value)}", node.step)


def _fail(printer: Printer, node: Fail, depth: int) -> None:
    printer.line(depth, f"raise Failed({printer.value(node.message)})", node.step)


def _break(printer: Printer, node: Break, depth: int) -> None:
    printer.line(depth, "break", node.step)


def _continue(printer: Printer, node: Continue, depth: int) -> None:
    printer.line(depth, "continue", node.step)


_OWN: Mapping[type[Node], Prints] = {
    Operate: _operate,
    Perform: _perform,
    If: _if,
    While: _while,
    Parallel: _parallel,
    Try: _try,
    Limit: _limit,
    Call: _call,
    Repeat: _repeat,
    ForEach: _for_each,
    Set: _set,
    Return: _return,
    Fail: _fail,
    Break: _break,
    Continue: _continue,
}
"""The nodes that are written in Python's own grammar, or by what a device or a function says of itself."""
PRINTERS: Mapping[type[Node], Prints] = {
    **_OWN,
    **{NODES[name]: printer_of(call) for name, call in CALLS.items()},
}
