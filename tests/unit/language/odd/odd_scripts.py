"""Scripts made by chance, most of them with mistakes that a check must find: what is told of them is kept in a file.

`python -m tests.unit.language.odd.odd_scripts` writes tests/cases/odd_scripts.json anew, which is to be read before it
is committed: each line that differs is told otherwise than it was.
"""

from __future__ import annotations

import json
import random
from dataclasses import dataclass, field
from pathlib import Path

from editor.language import Surroundings, compile_document, parse_script, tree_to_document
from editor.language.messages.diagnostics import arguments_to_json
from tests.kit.demo_site import factory

FILE = Path(__file__).parents[3] / "cases" / "odd_scripts.json"
HOW_MANY = 1_500
PLACES = ("shelf", "cans", "booth", "oven", "dock")
NUMBERS, LISTS = ("n", "m", "k"), ("xs", "ys")
CONDITIONS = ("self.oven.temperature > 60", "self.shelf.stock < 3", "distance(self.robot, self.oven) < 3")
HEAD = """class Task(object):
    def new_task(self):
"""
TAIL = """
    def run(self, ctx):
        self.shelf = ctx.get("itemInventory01")
        self.cans = ctx.get("paintInventory01")
        self.booth = ctx.get("paintMachine01")
        self.oven = ctx.get("curingOven01")
        self.dock = ctx.place("dock1")
        self.robot = ctx.any("pick", "drop")
        self.helper = ctx.any("pick", "drop")
        self.new_task()
"""


@dataclass
class Writer:
    """Writes one script; `functions` are those that its Parallels and Calls need, as they come."""

    chance: random.Random
    functions: list[str] = field(default_factory=list)

    def script(self) -> str:
        """Return a whole script."""
        begin = [f"self.{name} = {self.chance.randint(0, 3)}" for name in NUMBERS]
        begin += [f"self.{name} = [{', '.join(self.some())}]" for name in LISTS]
        body = self.indented([*begin, *self.block(0, self.chance.randint(3, 7))], 8)
        if "self.take" not in body + "".join(self.functions):
            return HEAD + body + "\n" + "".join(self.functions) + TAIL
        taking = "\n    def take(self, many: Number):\n" + self.indented(
            ["self.m = many", *self.block(2, 2, called=True)], 8
        )
        return HEAD + body + "\n" + "".join(self.functions) + taking + "\n" + TAIL

    def indented(self, lines: list[str], depth: int) -> str:
        """Return lines so far to the right."""
        return "\n".join(" " * depth + line for line in lines)

    def block(self, depth: int, most: int, *, loop: bool = False, called: bool = False) -> list[str]:
        """Return some steps; how they may end depends on where they stand."""
        lines = [line for _ in range(self.chance.randint(1, most)) for line in self.step(depth, loop=loop)]
        ends = ["break", "continue"] if loop else ["return"] if called else []
        if ends and self.chance.random() < 0.3:
            ending = self.chance.choice(ends)
            lines += [ending] if self.chance.random() < 0.3 else [f"if {self.condition()}:", f"    {ending}"]
        return lines

    def step(self, depth: int, *, loop: bool) -> list[str]:
        """Return the lines of one step."""
        plain = (
            self.go, self.pick, self.drop, self.carry, self.carry, self.put, self.put, self.wait, self.grow, self.rare,
        )  # fmt: skip
        nested = (self.branch, self.repeat, self.go_through, self.loop, self.attempt, self.beside)
        if depth >= 3 or self.chance.random() < 0.62:
            return self.chance.choice(plain)()
        return self.chance.choice(nested)(depth + 1, loop)

    def some(self) -> list[str]:
        """Return up to three numbers."""
        return [str(self.chance.randint(0, 3)) for _ in range(self.chance.randint(0, 3))]

    def number(self, depth: int = 0) -> str:
        """Return a number in words of the script."""
        chance, kind = self.chance, self.chance.randint(0, 9)
        if depth >= 2 or kind < 4:
            return str(chance.choice([0, 1, 1, 1, 1, 2, 2, 2, 3, 0.5]))
        if kind < 7:
            return f"self.{chance.choice(NUMBERS)}"
        if kind == 7:
            return chance.choice(
                [f"len(self.{chance.choice(LISTS)})", f"nth(self.{chance.choice(LISTS)}, {chance.randint(1, 3)})"]
            )
        return f"{self.number(depth + 1)} {chance.choice('+-*/')} {self.number(depth + 1)}"

    def condition(self) -> str:
        """Return what may hold or not."""
        chance, kind = self.chance, self.chance.randint(0, 6)
        if kind < 3:
            return chance.choice(CONDITIONS)
        if kind == 6:
            return f"{self.condition()} {chance.choice(['and', 'or'])} {self.condition()}"
        if kind == 5:
            return f"not ({self.condition()})"
        return f"{self.number(1)} {chance.choice(['<', '<=', '>', '>=', '==', '!='])} {self.number(1)}"

    def robot(self) -> str:
        """Return a role, seldom the second one."""
        return self.chance.choice(["robot"] * 7 + ["helper"])

    def go(self) -> list[str]:
        """Drive somewhere."""
        place = self.chance.choice(PLACES)
        return [f"self.{self.robot()}.move(self.{place}.location)"]

    def goods(self) -> str:
        """Return so many of something."""
        return f"{{'value': {self.number(1)}, 'object': '{self.chance.choice(['box'] * 7 + ['can'])}'}}"

    def pick(self) -> list[str]:
        """Take something."""
        role, place = self.robot(), self.chance.choice(["shelf"] * 6 + ["cans"])
        return [f"self.{role}.move(self.{place}.location)", f"self.{role}.pick({self.goods()})"]

    def drop(self) -> list[str]:
        """Leave something."""
        role, place = self.robot(), self.chance.choice(["booth"] * 6 + ["shelf"])
        return [f"self.{role}.move(self.{place}.location)", f"self.{role}.drop({self.goods()})"]

    def carry(self) -> list[str]:
        """Take as many as are left elsewhere; most of the time."""
        role, goods = self.robot(), self.goods()
        there = f"self.{role}.drop({goods if self.chance.random() < 0.8 else self.goods()})"
        lines = [f"self.{role}.move(self.shelf.location)", f"self.{role}.pick({goods})", *self.pause()]
        return [*lines, f"self.{role}.move(self.booth.location)", there]

    def pause(self) -> list[str]:
        """Return nothing, or what may change what was known."""
        return self.chance.choice([self.put, self.wait, self.rare])() if self.chance.random() < 0.3 else []

    def put(self) -> list[str]:
        """Give a variable a value."""
        name = self.chance.choice(NUMBERS)
        asked = "self.ask('How many?', type='number', minimum=0, maximum=2)"
        return [f"self.{name} = {asked if self.chance.random() < 0.15 else self.number()}"]

    def grow(self) -> list[str]:
        """Make a list longer, or another one."""
        name = self.chance.choice(LISTS)
        more = f"[{self.number(1)}]"
        return [f"self.{name} = self.{name} + {more}" if self.chance.random() < 0.6 else f"self.{name} = {more}"]

    def wait(self) -> list[str]:
        """Wait for a time, or for something to hold."""
        if self.chance.random() < 0.6:
            return [f"self.wait({self.number(1)})"]
        return [f"self.wait(until={self.condition()}, timeout={self.number(1)})"]

    def rare(self) -> list[str]:
        """Do what is done seldom."""
        lines = [
            *(f"self.{self.robot()}.release()" for _ in range(2)), "self.end()", "raise Failed('No.')",
            f"self.take(many={self.number(1)})", f"self.k = {self.number(1)}",
            f"self.notify(f'It is {{self.{self.chance.choice(NUMBERS)}}}', level='info')",
            f"self.oven.cure_paint({self.number(1)})",
        ]  # fmt: skip
        return [self.chance.choice(lines)]

    def within(self, head: str, depth: int, *, loop: bool) -> list[str]:
        """Return a block below its head."""
        return [head, *("    " + line for line in self.block(depth, 3, loop=loop))]

    def branch(self, depth: int, loop: bool) -> list[str]:
        """Do one or the other."""
        lines = self.within(f"if {self.condition()}:", depth, loop=loop)
        return lines + (self.within("else:", depth, loop=loop) if self.chance.random() < 0.5 else [])

    def repeat(self, depth: int, loop: bool) -> list[str]:
        """Do it so many times."""
        return self.within(f"for _ in range({self.number(1)}):", depth, loop=True)

    def go_through(self, depth: int, loop: bool) -> list[str]:
        """Do it for each of a list."""
        items = (
            f"[{', '.join(self.some()) or '1'}]" if self.chance.random() < 0.4 else f"self.{self.chance.choice(LISTS)}"
        )
        lines = self.within(f"for each in {items}:", depth, loop=True)
        take = ["self.robot.move(self.shelf.location)", "self.robot.pick({'value': each, 'object': 'box'})"]
        use = self.chance.choice([["self.n = each"], ["self.wait(each)"], take])
        return [lines[0], *("    " + line for line in use), *lines[1:]]

    def loop(self, depth: int, loop: bool) -> list[str]:
        """Do it while something holds."""
        head = "True" if self.chance.random() < 0.2 else self.condition()
        return self.within(f"while {head}:", depth, loop=True)

    def attempt(self, depth: int, loop: bool) -> list[str]:
        """Try it, or do it within a time."""
        if self.chance.random() < 0.3:
            return self.within(f"with self.limit({self.number(1)}):", depth, loop=loop)
        lines = self.within("try:", depth, loop=loop)
        kind = self.chance.choice([" TaskError", " Failed", " TimedOut"])
        lines += self.within(f"except{kind}:", depth, loop=loop) if self.chance.random() < 0.8 else []
        if self.chance.random() < 0.4 or lines[-1] == lines[0] or not any(line.startswith("except") for line in lines):
            lines += self.within("finally:", 3, loop=False)
        return lines

    def beside(self, depth: int, loop: bool) -> list[str]:
        """Do two things at once."""
        names = [f"branch_{len(self.functions) + number}" for number in (1, 2)]
        self.functions += ["", ""]  # so that branches inside get other names
        for name in names:
            body = self.indented(self.block(max(depth, 2), 2), 8)
            self.functions.append(f"\n    def {name}(self):\n{body}\n")
        needed = ", needed=1" if self.chance.random() < 0.3 else ""
        return [f"self.parallel({', '.join('self.' + name for name in names)}{needed})"]


def script_of(seed: int) -> str:
    """Return the script of a seed, always the same."""
    return Writer(random.Random(seed)).script()


def told_of(seed: int, site: Surroundings) -> list[str]:
    """Return what is told of the script of a seed, one by one: its line, its code and what it names."""
    parsed = parse_script(script_of(seed), site)
    found = list(parsed.diagnostics)
    if parsed.tree is not None:
        found = list(compile_document(tree_to_document(parsed.tree, site), site).diagnostics)
    named = [(each, arguments_to_json(each.args)) for each in found]
    return [" ".join(map(str, (each.line, each.code, *(args[name] for name in sorted(args))))) for each, args in named]


if __name__ == "__main__":
    lines = [f"{json.dumps(told_of(seed, factory()))}" for seed in range(HOW_MANY)]
    FILE.write_text("[\n" + ",\n".join(lines) + "\n]\n")
