"""Tree → plan, what decides which step comes next: branches, loops, guards and the exits from them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from editor.language.expressions import nodes as e
from editor.language.expressions.nodes import OF_PROBLEM
from editor.language.expressions.value_types import NUMBER
from editor.language.expressions.values import operation
from editor.language.plan import instructions as p
from editor.language.plan.builder import Around, Builder, Composite, Guard, Leaves, Loop
from editor.language.tree import nodes as n
from editor.language.tree.nodes import walk
from editor.language.tree.variable_types import type_of_items
from editor.language.tree.variables import reads_problem

_LEAVE = frozenset({n.Return, n.Break, n.Continue})
_ONE = e.Constant(1)
_ZERO = e.Constant(0)


def compile_if(builder: Builder, node: n.If, leaves: Leaves) -> None:
    """Compile an If."""
    branch = builder.add(p.Jump(0), node, enters=(node.step,))
    with builder.inside(Composite(node.step)):
        builder.block(node.then)
        over = builder.add(p.Jump(0)) if node.otherwise else -1
        builder.patch(branch, p.Branch(builder.value(node.condition), builder.here()))
        builder.block(node.otherwise)
    if node.otherwise:
        builder.patch(over, p.Jump(builder.here()))
    builder.leave(node)


def compile_while(builder: Builder, node: n.While, leaves: Leaves) -> None:
    """Compile a While."""
    branch = builder.add(p.Jump(0), node, enters=(node.step,))
    loop = _body(builder, node)
    builder.add(p.Jump(branch))
    builder.patch(branch, p.Branch(builder.value(node.condition), builder.here()))
    _close(builder, node, loop)


def compile_repeat(builder: Builder, node: n.Repeat, leaves: Leaves) -> None:
    """Compile a Repeat: a hidden variable counts how many times are left."""
    left = e.Variable(builder.hide("repeat"))
    builder.add(p.Assign(left.name, builder.value(node.times)), node, enters=(node.step,))
    branch = builder.add(p.Jump(0), node)
    loop = _body(builder, node)
    builder.add(p.Assign(left.name, e.Operation("-", (left, _ONE))))
    builder.add(p.Jump(branch))
    builder.patch(branch, p.Branch(e.Operation(">=", (left, _ONE)), builder.here()))
    _close(builder, node, loop)


def compile_for_each(builder: Builder, node: n.ForEach, leaves: Leaves) -> None:
    """Compile a For-each: a hidden variable counts, and tells which item comes next."""
    value_type = type_of_items(node, builder.types, builder.surroundings, builder.tree)
    index = e.Variable(builder.hide("item"))
    builder.add(p.Assign(index.name, _ZERO), node, enters=(node.step,))
    choose, count = _chooser(builder, node, index, value_type.unit)
    outside, types = builder.renamed, builder.types
    variable = builder.hide(node.variable)
    branch = builder.add(p.Jump(0), node)
    choose(variable)
    builder.renamed, builder.types = {**outside, node.variable: variable}, {**types, node.variable: value_type}
    if node.index:
        number = builder.hide(node.index)
        builder.renamed[node.index], builder.types = number, {**builder.types, node.index: NUMBER}
        builder.add(p.Assign(number, e.Operation("+", (index, _ONE))))
    loop = _body(builder, node)
    builder.renamed, builder.types = outside, types
    builder.add(p.Assign(index.name, e.Operation("+", (index, _ONE))))
    builder.add(p.Jump(branch))
    builder.patch(branch, p.Branch(e.Operation("<", (index, count)), builder.here()))
    _close(builder, node, loop)


def _chooser(
    builder: Builder, node: n.ForEach, index: e.Variable, unit: str
) -> tuple[Callable[[str], None], e.Expression]:  # fmt: skip
    """Keep what a loop goes through; return what gives a variable the item whose turn it is, and how many there are.

    A robot is looked up in its own round, for its role may have got it only in the round before.
    """
    if any(isinstance(item, e.Located) and item.role is not None for item in node.items):
        items = [_kept(builder, builder.value(item, unit)) for item in node.items]
        return lambda variable: _choose(builder, index, variable, items), e.Constant(len(items))
    listed = builder.value(operation("list", node.items) if node.over is None else node.over, unit)
    kept = e.Variable(builder.hide("list"))
    builder.add(p.Assign(kept.name, listed))

    def choose(variable: str) -> None:
        item = e.Operation("nth", (kept, e.Operation("+", (index, _ONE))))
        builder.add(p.Assign(variable, item))

    return choose, e.Operation("len", (kept,))


def _kept(builder: Builder, item: e.Expression) -> e.Expression:
    """Return an item that stays as it is at the beginning of the loop."""
    if isinstance(item, e.Constant | e.Located):
        return item
    name = builder.hide("value")
    builder.add(p.Assign(name, item))
    return e.Variable(name)


def _choose(builder: Builder, index: e.Variable, variable: str, items: Sequence[e.Expression]) -> None:
    """Give the loop's variable the item whose turn it is."""
    found: list[int] = []
    for number, item in enumerate(items):
        last = number == len(items) - 1
        branch = -1 if last else builder.add(p.Jump(0))
        builder.add(p.Assign(variable, item))
        if not last:
            found.append(builder.add(p.Jump(0)))
            is_this = e.Operation("==", (index, e.Constant(number)))
            builder.patch(branch, p.Branch(is_this, builder.here()))
    for address in found:
        builder.patch(address, p.Jump(builder.here()))


def _body(builder: Builder, node: n.While | n.Repeat | n.ForEach) -> Loop:
    loop = Loop()
    with builder.inside(loop):
        builder.block(node.body)
    for address in loop.rounds:
        builder.patch(address, p.Jump(builder.here()))
    return loop


def _close(builder: Builder, node: n.Node, loop: Loop) -> None:
    """All exits of a loop meet behind it."""
    for address in loop.jumps:
        builder.patch(address, p.Jump(builder.here()))
    builder.leave(node)


def compile_parallel(builder: Builder, node: n.Parallel, leaves: Leaves) -> None:
    """Compile a Parallel."""
    fork = builder.add(p.Jump(0), node, enters=(node.step,), leaves=leaves)
    entries: list[int] = []
    for branch in node.branches:
        entries.append(builder.here())
        with builder.inside():
            builder.block(branch)
        builder.add(p.Join())
    builder.patch(fork, p.Fork(tuple(entries), builder.here(), node.needed or 0 if node.races else 0))


def compile_try(builder: Builder, node: n.Try, leaves: Leaves) -> None:
    """Compile a Try; with a final part all of it stands in a guard that takes everything.

    The final part is there once. Whoever comes to it by a break or a return leaves a mark by which it goes on.
    """
    outer = Guard(_flag(builder, node) if node.final else "")
    enters = (node.step,)
    if node.final:
        if outer.flag:
            builder.add(p.Assign(outer.flag, _ZERO), node, enters=enters)
        outside = builder.add(p.Jump(0), node, enters=enters)
    with builder.inside(Composite(node.step), *([outer] if node.final else [])):
        if node.handlers:
            _guarded(builder, node)
        else:
            if not node.final:
                builder.add(p.Jump(builder.here() + 1), node, enters=enters)
            builder.block(node.body)
    if node.final:
        builder.add(p.TryEnd())
        builder.patch(outside, p.TryBegin(builder.here(), final=True))
        _final(builder, node, outer)
    builder.leave(node)


def compile_limit(builder: Builder, node: n.Limit, leaves: Leaves) -> None:
    """Compile a Limit: a guarded stretch that a timer ends; whoever leaves it leaves the guard as that of a Try."""
    builder.add(p.LimitBegin(builder.value(node.seconds, "SEC")), node, enters=(node.step,))
    with builder.inside(Composite(node.step), Guard()):
        builder.block(node.body)
    builder.add(p.TryEnd(), node, leaves=leaves)


def _flag(builder: Builder, node: n.Try) -> str:
    """Return the variable for exits through the final part, empty where there are none."""
    inside = (part for block in (node.body, *node.catches) for part in walk(block))
    return builder.hide("way") if any(part.__class__ in _LEAVE for part in inside) else ""


def _guarded(builder: Builder, node: n.Try) -> None:
    """Compile a body with its catches: a guard for each, the innermost for the first, as the innermost that fits takes.

    Before its steps a catch leaves the guards of those behind it, which are not for what fails in it.
    """
    last = len(node.handlers) - 1
    begins = [
        builder.add(p.Jump(0), node, enters=() if number else (node.step,)) for number in range(len(node.handlers))
    ]
    with builder.inside(*(Guard() for _ in node.handlers)):
        builder.block(node.body)
    for _ in node.handlers:
        builder.add(p.TryEnd())
    over = [builder.add(p.Jump(0))]
    for number, (begin, handler) in enumerate(zip(reversed(begins), node.handlers, strict=True)):
        builder.patch(begin, p.TryBegin(builder.here(), handler.kinds))
        _catch(builder, handler, behind=last - number)
        if number < last:
            over.append(builder.add(p.Jump(0)))
    for address in over:
        builder.patch(address, p.Jump(builder.here()))


def _catch(builder: Builder, handler: n.Catch, behind: int) -> None:
    """Compile the steps of a catch, with so many others behind it."""
    outside = builder.renamed
    if reads_problem(handler):
        hidden = [builder.hide(name) for name in OF_PROBLEM]
        builder.add(p.Caught(*hidden))
        builder.renamed = {**outside, **dict(zip(OF_PROBLEM, hidden, strict=True))}
    for _ in range(behind):
        builder.add(p.TryEnd())
    builder.block(handler.block)
    builder.renamed = outside


def _final(builder: Builder, node: n.Try, guard: Guard) -> None:
    begin = builder.here()
    with builder.inside(Composite(node.step)):
        builder.block(node.final)
    builder.add(p.Rethrow(), node)
    for number, (address, goes_on) in enumerate(guard.exits, start=1):
        builder.patch(address, p.Jump(begin))
        is_this = e.Operation("==", (e.Variable(guard.flag), e.Constant(number)))
        builder.add(p.Branch(is_this, builder.here() + 2))
        builder.add(p.Jump(goes_on))


def compile_break(builder: Builder, node: n.Break, leaves: Leaves) -> None:
    """Compile a Break: final parts on the path are carried out."""
    loop = _left_to_loop(builder, node, leaves)
    loop.jumps.append(builder.here() - 1)


def compile_continue(builder: Builder, node: n.Continue, leaves: Leaves) -> None:
    """Compile a Continue: as a Break, but that it goes on at the end of the body."""
    loop = _left_to_loop(builder, node, leaves)
    loop.rounds.append(builder.here() - 1)


def _left_to_loop(builder: Builder, node: n.Break | n.Continue, leaves: Leaves) -> Loop:
    """Leave all that stands between a step and its loop, by a jump, the last instruction, that is still open."""
    loop = next((item for item in reversed(builder.around) if isinstance(item, Loop)), None)
    assert loop is not None, "the checks found a loop around this step"
    passed = _until(builder.around, loop)
    builder.add(p.Jump(builder.here() + 1), node, enters=(node.step,), leaves=leaves)
    _leave_guards(builder, passed, passed)
    over = tuple(item.step for item in passed if isinstance(item, Composite))
    builder.add(p.Jump(0), leaves=over)
    return loop


def _until(around: list[Around], loop: Loop) -> list[Around]:
    """Return what stands between a step and its loop, the innermost first."""
    position = next(index for index, item in enumerate(around) if item is loop)
    return around[:position:-1]


def compile_return(builder: Builder, node: n.Return, leaves: Leaves) -> None:
    """Compile a Return: its value is worked out before the final parts on the path."""
    unit = builder.function.result_unit if builder.function else ""
    value = builder.given(node.value, unit)
    passed = builder.around[::-1]
    finals = [item for item in passed if isinstance(item, Guard) and item.flag]
    if not finals:
        builder.add(p.Return(value), node, enters=(node.step,), leaves=leaves)
        return
    if value is not None and not isinstance(value, e.Constant):
        name = builder.hide("result")
        builder.add(p.Assign(name, value), node, enters=(node.step,))
        value = e.Variable(name)
    builder.add(p.Jump(builder.here() + 1), node, enters=(node.step,), leaves=leaves)
    _leave_guards(builder, passed, passed[: passed.index(finals[-1]) + 1])
    builder.add(p.Return(value))


def _leave_guards(builder: Builder, passed: list[Around], left: list[Around]) -> None:
    """Leave guards, the innermost first; behind each final part the path goes on here."""
    for guard in left:
        if isinstance(guard, Guard):
            builder.add(p.TryEnd())
            if guard.flag:
                builder.add(p.Assign(guard.flag, e.Constant(len(guard.exits) + 1)))
                address = builder.add(p.Jump(0))
                guard.exits.append((address, builder.here()))
