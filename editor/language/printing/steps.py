"""Nodes of the tree → lines of the script; one small function for each kind of node."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from editor.language.expressions.names import member_name
from editor.language.expressions.nodes import PlaceRef
from editor.language.expressions.printing import quote, scalar_text
from editor.language.expressions.units import unit_symbol
from editor.language.printing.writer import Printer, point_text
from editor.language.tree.nodes import (
    ERROR_CLASSES,
    Ask,
    Break,
    Call,
    Drop,
    End,
    ForEach,
    If,
    Move,
    Node,
    Notify,
    Operate,
    Parallel,
    Pick,
    Repeat,
    Return,
    Set,
    Try,
    Wait,
    WaitUntil,
    While,
)
from editor.language.tree.numbering import letters_of


def _move(printer: Printer, node: Move, depth: int) -> None:
    via = f", via=[{', '.join(map(point_text, node.route))}]" if node.route else ""
    printer.line(depth, f"self.{node.role}.move({printer.place(node.to)}{via})", node.step)


def _pick(printer: Printer, node: Pick, depth: int) -> None:
    printer.line(depth, f"self.{node.role}.pick({_load(printer, node)})", node.step)


def _drop(printer: Printer, node: Drop, depth: int) -> None:
    printer.line(depth, f"self.{node.role}.drop({_load(printer, node)})", node.step)


def _load(printer: Printer, node: Pick | Drop) -> str:
    return f'{{"value": {printer.value(node.quantity)}, "object": {printer.value(node.object)}}}'


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
            ordered = [given.get(parameter.name) for parameter in method.parameters]
            while ordered and ordered[-1] is None and not method.parameters[len(ordered) - 1].required:
                ordered.pop()
            values = ("None" if value is None else printer.value(value) for value in ordered)
            return f"{member}({', '.join(values)})"
    name = quote(node.method) if node.method else "None"
    arguments = ", ".join(f"{quote(key)}: {printer.value(value)}" for key, value in node.arguments)
    return f"operate({name}, {{{arguments}}})" if arguments else f"operate({name})"


def _wait(printer: Printer, node: Wait, depth: int) -> None:
    printer.line(depth, f"self.wait({printer.value(node.seconds)})", node.step)


def _wait_until(printer: Printer, node: WaitUntil, depth: int) -> None:
    timeout = "" if node.timeout_s is None else f", timeout={printer.value(node.timeout_s)}"
    printer.line(depth, f"self.wait(until={printer.value(node.condition)}{timeout})", node.step)


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
    printer.line(depth, f"self.parallel({', '.join([*references, *handed_on])})", node.step)


def _try(printer: Printer, node: Try, depth: int) -> None:
    printer.line(depth, "try:", node.step)
    printer.block(node.body, depth + 1)
    if node.catches:
        classes = [ERROR_CLASSES[kind] for kind in node.kinds] or ["TaskError"]
        caught = classes[0] if len(classes) == 1 else f"({', '.join(classes)})"
        printer.line(depth, f"except {caught} as problem:", node.step)
        printer.block(node.catch, depth + 1)
    if node.final or not node.catches:
        printer.line(depth, "finally:", node.step)
        printer.block(node.final, depth + 1)


def _call(printer: Printer, node: Call, depth: int) -> None:
    arguments = ", ".join(f"{name}={printer.value(value)}" for name, value in node.arguments)
    text = f"self.{node.function}({arguments})" if node.function else "self.call(None)"
    printer.line(depth, _taken(printer, node.result, text), node.step)


def _taken(printer: Printer, variable: str, text: str) -> str:
    """Return a call whose value goes into a variable, if there is one."""
    return f"{printer.variable(variable)} = {text}" if variable else text


def _repeat(printer: Printer, node: Repeat, depth: int) -> None:
    printer.line(depth, f"for _ in range({printer.value(node.times)}):", node.step)
    printer.block(node.body, depth + 1)


def _for_each(printer: Printer, node: ForEach, depth: int) -> None:
    items = ", ".join(map(printer.value, node.items))
    printer.line(depth, f"for {node.variable or '_'} in [{items}]:", node.step)
    outside = printer.locals
    if node.variable and node.variable not in outside:
        printer.locals = (*outside, node.variable)
    printer.block(node.body, depth + 1)
    printer.locals = outside


def _set(printer: Printer, node: Set, depth: int) -> None:
    value = printer.value(node.value)
    text = f"{printer.variable(node.variable)} = {value}" if node.variable else f"self.set(None, {value})"
    printer.line(depth, text, node.step)


def _ask(printer: Printer, node: Ask, depth: int) -> None:
    answer = node.answer
    limits = {"minimum": answer.minimum, "maximum": answer.maximum}
    given = [printer.value(node.question), f"type={quote(answer.type)}"]
    given += [f"unit={quote(unit_symbol(answer.unit))}"] if answer.unit else []
    given += [f"{name}={scalar_text(limit)}" for name, limit in limits.items() if limit is not None]
    given += [f"options=[{', '.join(map(quote, answer.options))}]"] if answer.options else []
    given += [] if node.timeout_s is None else [f"timeout={printer.value(node.timeout_s)}"]
    printer.line(depth, _taken(printer, node.variable, f"self.ask({', '.join(given)})"), node.step)


def _notify(printer: Printer, node: Notify, depth: int) -> None:
    printer.line(depth, f"self.notify({printer.value(node.message)}, level={quote(node.level)})", node.step)


def _end(printer: Printer, node: End, depth: int) -> None:
    printer.line(depth, "self.end()", node.step)


def _return(printer: Printer, node: Return, depth: int) -> None:
    printer.line(depth, "return" if node.value is None else f"return {printer.value(node.value)}", node.step)


def _break(printer: Printer, node: Break, depth: int) -> None:
    printer.line(depth, "break", node.step)


PRINTERS: Mapping[type[Node], Callable[..., None]] = {
    Move: _move,
    Pick: _pick,
    Drop: _drop,
    Operate: _operate,
    Wait: _wait,
    WaitUntil: _wait_until,
    If: _if,
    While: _while,
    Parallel: _parallel,
    Try: _try,
    Call: _call,
    Repeat: _repeat,
    ForEach: _for_each,
    Set: _set,
    Ask: _ask,
    Notify: _notify,
    End: _end,
    Return: _return,
    Break: _break,
}
