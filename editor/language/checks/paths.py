"""Checks along the paths of a program: what the interpreter and its domains find, and what it never comes to."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from editor.language.analysis.calls import follow_function
from editor.language.analysis.crew import Crew
from editor.language.analysis.domain import Domain
from editor.language.analysis.effects import EffectTable, together
from editor.language.analysis.interpreter import FOLLOW, interpret
from editor.language.analysis.loads import HOLDS, Loads
from editor.language.analysis.taken import Takers
from editor.language.analysis.uses import uses_of
from editor.language.analysis.variables import SET, UNSET, Variables
from editor.language.analysis.walk import Walk
from editor.language.checks.bodies import Body, Checks
from editor.language.checks.context import Context
from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Reading, Variable
from editor.language.expressions.ranges import NOTHING_KNOWN
from editor.language.expressions.values import parts_of
from editor.language.messages.diagnostics import Fix
from editor.language.site.surroundings import what_programs_see
from editor.language.tree import nodes as n
from editor.language.tree.nodes import blocks_of
from editor.language.tree.program import Function, Tree
from editor.language.tree.traversal import callees_first, functions_in_circles
from editor.language.tree.variables import SETTERS
from vipo_device.protocol.description import Description

_MEASURED = frozenset({"now", "distance", "nearest"})
_MILDER: Mapping[str, str] = {
    "carrying_too_much": "may_carry_too_much",
    "drops_nothing": "may_drop_nothing",
    "unset_variable": "may_be_unset",
    "out_of_range": "may_be_out_of_range",
    "divided_by_zero": "may_divide_by_zero",
    "no_such_item": "may_be_no_such_item",
    "no_robot_yet": "perhaps_no_robot_yet",
    "releases_carrying": "may_release_carrying",
}
"""What is sure on one path is not told again as what may be on another."""
NO_STEPS: frozenset[int] = frozenset()
MOST_LOOKS = 16
"""A step is checked with so much different knowledge of the variables that it reads."""


@dataclass(slots=True)
class _Looker:
    """Checks the steps that read variables once more, where the walk comes to them and knows these."""

    context: Context
    checks: Checks
    variables: Variables
    bodies: Mapping[str, Body]
    reads: Mapping[int, Mapping[str, str]]
    takers: Takers | None = None
    asked: Mapping[int, Mapping[str, str]] = field(default_factory=dict)
    """The roles whose robots' places steps ask for, by the identity of the step."""
    _looked: dict[int, set[object]] = field(default_factory=dict)

    def look(self, walk: Walk, node: n.Node) -> None:
        """Check a step with what is known of the variables that it reads, and of the robots that it asks for."""
        if self.takers is not None and id(node) in self.asked:
            self.takers.tell(walk, walk.states[1], node, self.asked[id(node)])
        if id(node) in self.reads:
            self._look_at_variables(walk, node)

    def _look_at_variables(self, walk: Walk, node: n.Node) -> None:
        context, reads, seen = self.context, self.reads[id(node)], self.variables.seen(walk)
        for name, field_name in reads.items():
            state = self.variables.state_of(walk, name)
            if state != SET:
                code = "unset_variable" if state == UNSET else "may_be_unset"
                walk.report(node, code, field_name, {"variable": name})
        known = tuple(seen.get(name) for name in reads)
        looked = self._looked.setdefault(id(node), {(None,) * len(reads)})
        if known in looked or len(looked) > MOST_LOOKS:
            return
        looked.add(known)
        self.bodies[walk.frame.name].enter(context, node)
        found, context.found, context.known = context.found, [], seen
        if (check := self.checks.get(type(node))) is not None:
            check(context, node)
        for problem, key in context.found:
            walk.found.setdefault((problem.code, key, problem.field), problem)
        context.found, context.known = found, NOTHING_KNOWN


def check_paths(context: Context, bodies: Iterable[Body], checks: Checks) -> None:
    """Follow all paths through the program, its events and its functions, and tell what is wrong on them."""
    tree, by_name = context.tree, {body.name: body for body in bodies}
    effects = EffectTable(tree)
    uses = uses_of(tree, context.memos.uses if context.memos else None)
    variables = Variables(
        context.surroundings, tree.parameters, lambda name, node: by_name[name].types_at(node), frozenset(uses.sets)
    )
    others: list[Domain[Any]] = [*_loads(context, variables), *_crew(context, effects)]
    takers, asked = _takers(context, uses.asks)
    if takers is not None or _has_variables(tree):
        looker = _Looker(context, checks, variables, by_name, uses.reads, takers, asked)
        others = others if takers is None else [takers, *others]
        readers = frozenset(uses.reads.keys() | asked.keys())
        walk = Walk(tree, [variables, *others], effects, FOLLOW, variables, looker.look, readers)
        changed = together(effects.of(event.body) for event in tree.events)
        walk.volatile = dict.fromkeys(changed.names | changed.shared)
    else:
        walk = Walk(tree, others, effects, FOLLOW)
    if context.memos is not None:
        walk.memo = context.memos.paths
        robots = [(role, context.capacity(role.name), context.robots(role.name)) for role in tree.roles]
        types = [(body.name, body.types) for body in bodies]
        walk.memo.begin((dict(walk.volatile), tree.parameters, types, robots, what_programs_see(context.surroundings)))
    interpret(walk)
    _take_holds(context, walk)
    _tell_of_small_robots(context, walk, variables)
    sure = {(code, node) for code, node, _ in walk.found}
    milder = {(mild, node) for code, node in sure for mild in (_MILDER.get(code),) if mild}
    context.found.extend((p, node) for (code, node, _), p in walk.found.items() if (code, node) not in milder)
    _tell_unreached(context, walk)
    _tell_endless(context, walk)
    if tree.functions:
        _check_results(context, walk)


def _take_holds(context: Context, walk: Walk) -> None:
    """Take what roles must hold out of what was found."""
    for key in [key for key in walk.found if key[0] == HOLDS]:
        role = str(walk.found.pop(key).args["role"])
        context.holds[role] = max(context.holds.get(role, 0), int(key[2]))


def _tell_of_small_robots(context: Context, walk: Walk, variables: Variables) -> None:
    """Follow the crew once more where a robot is too small for what its role holds, which is known only now."""
    roles = [role for name, role in context.roles.items() if role.device is None and name in context.holds]
    if all(_is_large_enough(context, role.name, robot) for role in roles for robot in context.robots(role.name)):
        return
    for crew in _crew(context, walk.effects):
        again = Walk(context.tree, [variables, crew], walk.effects, FOLLOW, variables, volatile=walk.volatile)
        interpret(again)
        walk.found.update(again.found)


def _is_large_enough(context: Context, role: str, robot: Description) -> bool:
    """Tell whether a robot holds what its role needs; one that does not say how much may hold enough."""
    return not 0 < robot.capacity < context.holds.get(role, 0) or context.roles[role].device is not None


def _crew(context: Context, effects: EffectTable) -> Iterator[Crew]:
    if len({context.robot_key(role) for role in context.roles}) > 1:
        beside = together(effects.of(event.body) for event in context.tree.events).released
        yield Crew(lambda role: (context.robot_key(role), _robots(context, role)), beside)


def _robots(context: Context, role: str) -> list[str]:
    return [robot.id for robot in context.robots(role) if _is_large_enough(context, role, robot)]


def _takers(
    context: Context, asks: Mapping[int, Mapping[str, str]]
) -> tuple[Takers | None, Mapping[int, Mapping[str, str]]]:
    """Return the domain of taken robots, where steps ask for the place of one that is not known yet, or release one."""
    free = {name for name, role in context.roles.items() if role.device is None}
    asked = {
        node: {role: field for role, field in roles.items() if role in free}
        for node, roles in asks.items()
        if not free.isdisjoint(roles)
    }
    released = {node.role for node in context.tree.of_kind(n.Release)}
    told = released | free if asked else released
    return (Takers(frozenset(told)) if told else None), asked


def _loads(context: Context, variables: Variables) -> Iterator[Loads]:
    if context.tree.holds(*n.LOADS):
        yield Loads(variables, context.capacity, context.robot_name, frozenset(context.roles))


def _has_variables(tree: Tree) -> bool:
    given = any(function.parameters for function in tree.functions)
    return given or bool(tree.parameters) or tree.holds(*SETTERS, n.ForEach)


def _blocks(tree: Tree) -> Iterator[n.Block]:
    yield tree.body
    yield from (event.body for event in tree.events)
    yield from (function.body for function in tree.functions)


def _all_nodes(tree: Tree) -> Iterator[n.Node]:
    for block in _blocks(tree):
        yield from tree.walked(block)


def _tell_unreached(context: Context, walk: Walk) -> None:
    """Tell of the first step in each block that no path leads to, though one leads to the step before it."""
    if len(walk.visited) == sum(len(context.tree.walked(block)) for block in _blocks(context.tree)):
        return
    left = list(_blocks(context.tree))
    while left:
        block = left.pop()
        for index, node in enumerate(block):
            if id(node) not in walk.visited:
                before = block[index - 1] if index else None
                if before is not None and before.step != node.step:
                    fix = Fix("delete_step", node.step, "delete", None)
                    context.report(node, "never_reached", "", fix=fix)
                break
            if node.__class__ in n.COMPOSITES:
                left.extend(blocks_of(node))


def _tell_endless(context: Context, walk: Walk) -> None:
    """Tell of loops and calls that are never left, and of loops of which nothing says that they are."""
    _tell_endless_calls(context, walk)
    races = [node for node in context.tree.of_kind(n.Parallel) if node.races]
    for race in races:
        if id(race) in walk.endless:
            context.report(race, "too_few_end", "needed", {"needed": race.needed or 0})
    if not context.tree.holds(n.While):
        return
    beside = frozenset(walk.volatile)
    if context.tree.holds(n.Parallel):
        changed = together(walk.changes(*node.branches) for node in context.tree.of_kind(n.Parallel))
        beside = beside | changed.names | changed.shared
    stays = {id(node) for node in context.tree.of_kind(n.While) if _may_stay(walk, node, beside)}
    called_off = _called_off(context, walk, races, stays) if stays and races else NO_STEPS
    for node in context.tree.of_kind(n.While):
        if id(node) in walk.endless:
            context.report(node, "never_ends", "condition")
        elif id(node) in stays and id(node) not in called_off:
            context.report(node, "may_never_end", "condition")


def _called_off(context: Context, walk: Walk, races: list[n.Parallel], stays: set[int]) -> frozenset[int]:
    """Return the loops that need no end, since enough branches beside them have one, or of which that is told."""
    found: set[int] = set()
    for race in races:
        loops = [{id(node) for node in context.tree.walked(branch)} & stays for branch in race.branches]
        if sum(not inner for inner in loops) >= (race.needed or 0) or id(race) in walk.endless:
            found.update(*loops)
    return frozenset(found)


def _tell_endless_calls(context: Context, walk: Walk) -> None:
    """A function that calls itself must have a path on which it does not."""
    circular = functions_in_circles(context.tree) if context.tree.functions else frozenset()
    endless = functions_without_end(context.tree, walk.effects) & circular if circular else circular
    for function in context.tree.functions if endless else ():
        if function.method in endless:
            name = {"function": function.name or function.method}
            for node in context.tree.walked(function.body):
                if isinstance(node, n.Call) and node.function in endless:
                    context.report(node, "calls_itself", "function", name)
    for call in context.tree.of_kind(n.Call) if circular and walk.endless else ():
        if id(call) in walk.endless and call.function not in endless:
            called = context.functions[call.function]
            context.report(call, "calls_itself", "function", {"function": called.name or called.method})


def functions_without_end(tree: Tree, effects: EffectTable) -> frozenset[str]:
    """Return the functions that neither come back nor end the program; a call that never comes back leads nowhere."""
    leaves = {function.method: False for function in tree.functions}
    comes_back = dict(leaves)
    changed, functions = bool(leaves), callees_first(tree)
    while changed:
        changed = False
        for function in functions:
            walk = Walk(tree, (), effects, FOLLOW, summaries=comes_back)
            over = follow_function(walk, function, [])
            ends = (
                walk.ended > 0
                or bool(walk.failures)
                or any(leaves[node.function] and not comes_back[node.function] for node in _calls(walk, tree, function))
            )
            if (over is not None) != comes_back[function.method] or (over is not None or ends) != leaves[
                function.method
            ]:
                comes_back[function.method], leaves[function.method] = over is not None, over is not None or ends
                changed = True
    return frozenset(method for method, leaves_it in leaves.items() if not leaves_it)


def _calls(walk: Walk, tree: Tree, function: Function) -> Iterator[n.Call]:
    """Yield the calls that a walk over a function came to."""
    for node in tree.walked(function.body):
        if isinstance(node, n.Call) and id(node) in walk.visited and node.function in walk.functions:
            yield node


def _may_stay(walk: Walk, node: n.While, beside: frozenset[str]) -> bool:
    """Tell whether nothing leaves a loop, nor changes what its condition looks at."""
    begun = id(node) in walk.visited and id(node) not in walk.broken
    return begun and not isinstance(node.condition, Constant) and not _may_change(walk, node, beside)


def _may_change(walk: Walk, node: n.While, beside: frozenset[str]) -> bool:
    """Tell whether the condition can become false: what it looks at is measured, or set while the loop runs."""
    parts = parts_of(node.condition)
    if any(map(_is_measured, parts)):
        return True
    names = {part.name for part in parts if isinstance(part, Variable)}
    missing = any(isinstance(part, Constant) and part.value is None for part in parts)
    if missing or names & beside:
        return True
    changed = walk.effects.of(node.body)
    return bool(names & (changed.names | changed.shared))


def _is_measured(part: Expression) -> bool:
    if isinstance(part, Operation):
        return part.operator in _MEASURED
    return isinstance(part, Reading) or (isinstance(part, Located) and (part.role or part.zone) is not None)


def _check_results(context: Context, walk: Walk) -> None:
    """A function that gives a value gives one on every path, and whoever calls it takes the value."""
    for function in context.tree.functions:
        if not function.result_type:
            continue
        name = {"function": function.name or function.method}
        nodes = context.tree.walked(function.body)
        bare: list[n.Node] = [node for node in nodes if isinstance(node, n.Return) and node.value is None]
        if function.method in walk.falls_off and function.body:
            bare.append(function.body[-1])
        for node in bare:
            context.report(node, "no_value_on_some_way", "", name)
    for call in context.tree.of_kind(n.Call):
        called = context.functions.get(call.function)
        if called is not None and called.result_type:
            if not call.result:
                context.report(call, "unused_result", "result", {"function": called.name or called.method})
            if not called.body:
                context.report(call, "no_value_on_some_way", "", {"function": called.name or called.method})
