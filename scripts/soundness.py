"""Soundness by trial: programs by chance that check clean are carried out, and may not fail for what their text tells.

`python -m scripts.soundness --programs 10000 --seed 1` makes so many programs. One that is clean, without error and
warning, is run by the real machine against devices that do what they are asked, with readings by chance; a judge
knows what every robot carries. It ends with status 1, and the documents, where a run did what the checks must tell.
"""

from __future__ import annotations

import argparse
import json
import random
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from editor.language import Surroundings, compile_document, surroundings_from_json
from editor.language.document.catches import catches_of
from editor.language.expressions.nodes import AnswerSpec
from editor.language.plan.instructions import Plan
from execution.machine import machine
from execution.machine import messages as m
from execution.machine.places import ROLE

Json = dict[str, Any]
SITE = Path(__file__).resolve().parent.parent / "examples" / "painting-factory.json"
OVEN = ("curingOven01", "temperature")
BATTERY = ("robot01", "battery")
SHELF, BOOTH = {"device": "itemInventory01"}, {"device": "paintMachine01"}
LEAST_CURING_S, MOST_CURING_S = 1, 3600
CAPACITY = 2
MOST_EVENTS = 600
NAMES = ("n", "left", "seconds")
_MAY_BE = ("calls itself more than", "The time limit of")
"""Why a clean program may fail: a function that calls itself until a reading changes comes to the machine's limit, and
what takes longer than its time limit has timed out."""
HARMLESS = {"unused_variable", "unused_parameter", "empty_branch", "busy_circle", "releases_nothing"}
"""What is told of a program that does all the same what it says."""
MORE = 0.75
"""How often one more step follows, the deeper the seldomer."""


_TRIES: tuple[Json, ...] = (
    {"kinds": ["timed_out"]},
    {"kinds": ["offline"], "kinds2": ["timed_out"]},
    {"kinds": ["timed_out"], "kinds2": [], "kinds3": ["failed"]},
    {"catch": False, "kinds2": ["failed", "timed_out"]},
)


@dataclass
class Draft:
    """A program while it is made up; what is not set yet is seldom read, so that many programs are clean."""

    chance: random.Random
    steps: Json = field(default_factory=dict)
    known: set[str] = field(default_factory=set)
    functions: Json = field(default_factory=dict)
    lists: bool = False
    """Whether some step has set a list."""

    def add(self, parent: str, branch: str, kind: str, params: Json) -> str:
        """Add a step at the end of a branch."""
        name = f"s{len(self.steps):03d}"
        self.steps[name] = {"kind": kind, "place": [parent, branch, f"{name}V"], "pos": [0, 0], "params": params}
        return name

    def block(self, parent: str, branch: str, depth: int, inside: frozenset[str] = frozenset()) -> None:
        """Fill a branch."""
        while self.chance.random() < MORE - depth * 0.1:
            kinds = [
                "load",
                "load",
                "set",
                "ask",
                "wait",
                "cure",
                "notify",
                "if",
                "repeat",
                "each",
                "list",
                "of_list",
                "item",
                "while",
                "call",
                "parallel",
                "limit",
                "release",
            ]
            kind = self.chance.choice(
                kinds[: 7 if depth > 3 else None] + [k for k in ("break", "next_round") if k in inside]
            )
            getattr(self, f"_{kind}")(parent, branch, depth, inside)

    def number(self) -> Any:
        """Return a number that may be worked out from variables."""
        plain = self.chance.choice([0, 1, 1, 2, 2, 3, 5])
        if not self.known or self.chance.random() < 0.4:
            return plain
        name = {"param": self.chance.choice(sorted(self.known))}
        return self.chance.choice([name, {"op": self.chance.choice("+-*"), "args": [name, plain]}])

    def condition(self) -> Json:
        """Return a condition on a reading or a variable."""
        if not self.known or self.chance.random() < 0.5:
            asked = {"property": [{"role": "robot"}, "battery"] if self.chance.random() < 0.3 else [*OVEN]}
            return {"op": self.chance.choice("<>"), "args": [asked, 60]}
        name = {"param": self.chance.choice(sorted(self.known))}
        return {"op": self.chance.choice(["<", ">", "<=", "=="]), "args": [name, self.chance.randrange(4)]}

    def _load(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        quantity: Any = 1 if self.chance.random() < 0.7 else self.number()
        for kind, at in (("pick", SHELF), ("drop", BOOTH)):
            if self.chance.random() < 0.9:
                params = {"role": "robot", "at": at, "object": "box", "quantity": quantity}
                self.add(parent, branch, kind, params)

    def _set(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        name = self.chance.choice(NAMES)
        self.add(parent, branch, "set", {"variable": name, "value": self.number()})
        self.known.add(name)

    def _ask(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        name, least = self.chance.choice(NAMES), self.chance.choice([0, 1])
        answer = {"type": "number", "minimum": least, "maximum": least + self.chance.randrange(3)}
        self.add(parent, branch, "ask", {"question": "How many?", "answer": answer, "variable": name})
        self.known.add(name)

    def _wait(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        seconds = {"op": "*", "args": [self.number(), {"quantity": [1, "SEC"]}]}
        self.add(parent, branch, "wait", {"duration": self.chance.choice([2, seconds])})

    def _cure(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        time = {"op": "*", "args": [self.number(), {"quantity": [self.chance.choice([1, 20]), "MIN"]}]}
        params = {"device": {"device": "curingOven01"}, "method": "curePaint", "args": {"time": time}}
        self.add(parent, branch, "operate", params)

    def _notify(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        value = {"op": "/", "args": [6, self.number()]} if self.known else 1
        self.add(parent, branch, "notify", {"message": {"op": "text", "args": ["Left: ", value]}, "level": "info"})

    def _if(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        step = self.add(parent, branch, "if", {"condition": self.condition()})
        before = set(self.known)
        for name in ("then", "else"):
            self.known = set(before)
            self.block(step, name, depth + 1, inside)
        if self.chance.random() < 0.8:
            self.known = before

    def _repeat(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        times = self.chance.choice([0, 1, 2, 3]) if self.chance.random() < 0.7 else self.number()
        step = self.add(parent, branch, "repeat", {"times": times})
        self.block(step, "body", depth + 1, inside | {"break", "next_round"})

    def _each(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        """A loop over numbers, which may look at the number and at the item of its round."""
        items = [self.number() for _ in range(self.chance.randrange(1, 4))]
        step = self.add(parent, branch, "for_each", {"variable": "item", "index": "round", "items": items})
        before = set(self.known)
        self.known |= {"item", "round"}
        self.block(step, "body", depth + 1, inside | {"break", "next_round"})
        self.known -= {"item", "round"} - before

    def _list(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        """A list that is set anew, or gets an item more."""
        item = {"op": "list", "args": [self.number()]}
        longer = {"op": "+", "args": [{"param": "items"}, item]}
        whole = {"op": "list", "args": [self.number() for _ in range(self.chance.randrange(3))]}
        again = self.lists and self.chance.random() < 0.6
        self.add(parent, branch, "set", {"variable": "items", "value": longer if again else whole})
        self.lists = True

    def _of_list(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        if self.lists:
            params = {"variable": "item", "index": "round", "list": {"param": "items"}}
            step, before = self.add(parent, branch, "for_each", params), set(self.known)
            self.known |= {"item", "round"}
            self.block(step, "body", depth + 1, inside | {"break", "next_round"})
            self.known -= {"item", "round"} - before

    def _item(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        """One item, by a number that may be too large, sometimes only where the list is long enough."""
        if not self.lists:
            return
        number = self.number()
        if self.chance.random() < 0.5:
            enough = {"op": ">=", "args": [{"op": "len", "args": [{"param": "items"}]}, 2]}
            parent, branch, number = self.add(parent, branch, "if", {"condition": enough}), "then", 2
        name = self.chance.choice(NAMES)
        value = {"op": "nth", "args": [{"param": "items"}, number]}
        self.add(parent, branch, "set", {"variable": name, "value": value})

    def _while(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        step = self.add(parent, branch, "while", {"condition": self.condition()})
        before = set(self.known)
        self.block(step, "body", depth + 1, inside | {"break", "next_round"})
        if self.chance.random() < 0.8:
            self.known = before

    def _parallel(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        race = {"needed": 1} if self.chance.random() < 0.4 else {}
        step = self.add(parent, branch, "parallel", {"branches": ["a", "b"], **race})
        self._set(step, "a", depth, frozenset())
        self._wait(step, "b", depth, frozenset())
        self.block(step, self.chance.choice("ab"), depth + 1)

    def _limit(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        before, caught = set(self.known), self.chance.random() < 0.5
        if caught:
            parent, branch = self.add(parent, branch, "try", self.chance.choice(_TRIES)), "body"
        time = {"op": "*", "args": [self.number(), {"quantity": [1, "MIN"]}]}
        step = self.add(parent, branch, "limit", {"duration": self.chance.choice([600, time])})
        self.block(step, "body", depth + 1, inside)
        if caught:  # what is known behind a failure is little, and little is told of it
            self.known = before
            for catch in catches_of(self.steps[parent]["params"]):
                self.add(parent, catch, "notify", {"message": {"param": "problem.text"}, "level": "info"})
                self.add(parent, catch, "end", {})

    def _release(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        self.add(parent, branch, "release", {"role": "robot"})

    def _break(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        self.add(parent, branch, "break", {})

    def _next_round(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        self.add(parent, branch, "continue", {})

    def _call(self, parent: str, branch: str, depth: int, inside: frozenset[str]) -> None:
        function = self.chance.choice(["f", "g"])
        if function == parent or parent in self.functions:
            return
        self.functions[function] = {"name": function, "parameters": [{"name": "given", "type": "number"}]}
        self.add(parent, branch, "call", {"function": function, "args": {"given": self.number()}})


def make_program(seed: int) -> Json:
    """Return the document of a program by chance."""
    draft = Draft(random.Random(seed))  # noqa: S311 - a sample, not a secret
    for _ in range(2):
        draft.block("program", "body", 0)
    shared, draft.known = draft.known, {"given"}
    for function in sorted(draft.functions):
        draft.known = {"given", *(name for name in shared if draft.chance.random() < 0.3)}
        draft.block(function, "body", 2)
    return {"format": 2, "start_pos": [0, 0], "steps": draft.steps, "functions": draft.functions}


@dataclass
class Judge:
    """The devices of a run: they do all that they are asked, and note what cannot be done."""

    plan: Plan
    chance: random.Random
    carried: int = 0
    wrong: str = ""
    roles: dict[tuple[str, str], str] = field(default_factory=dict)
    """The robots that roles have got, as facts."""

    def run(self) -> str:
        """Carry the plan out and return what went wrong; empty where nothing did."""
        state, actions = machine.start(self.plan, {}, self._readings(), 0)
        waits: list[m.Ask | m.SetTimer | m.AskPeople] = []
        for _ in range(MOST_EVENTS):
            waits += [a for a in actions if isinstance(a, m.Ask | m.SetTimer | m.AskPeople)]
            waits = self._without_called_off(waits, {a.task for a in actions if isinstance(a, m.Cancel)})
            if state.status != "running" or self.wrong:
                break
            event = self._something(waits)
            if isinstance(event, m.TaskDone) and self.roles:
                state, actions = machine.step(self.plan, state, m.Facts(self.roles))
                waits += [a for a in actions if isinstance(a, m.Ask | m.SetTimer | m.AskPeople)]
            state, actions = machine.step(self.plan, state, event)
        if not self.wrong and state.status == "failed":
            reason = next(a.reason for a in actions if isinstance(a, m.Finished))
            self.wrong = "" if any(said in reason for said in _MAY_BE) else reason
        return self.wrong

    def _without_called_off(
        self, waits: list[m.Ask | m.SetTimer | m.AskPeople], called_off: set[int]
    ) -> list[m.Ask | m.SetTimer | m.AskPeople]:
        """Take back what is not wanted any more; a robot may all the same have done it."""
        dropped = [wait for wait in waits if isinstance(wait, m.Ask) and wait.task in called_off]
        for ask in dropped:
            if self.chance.random() < 0.5:
                self._carry_out(ask)
        return [wait for wait in waits if wait not in dropped]

    def _readings(self) -> Mapping[tuple[str, str], float]:
        return {OVEN: self.chance.choice([20.0, 80.0]), BATTERY: self.chance.choice([5, 95])}

    def _something(self, waits: list[m.Ask | m.SetTimer | m.AskPeople]) -> m.Event:
        if not waits or self.chance.random() < 0.2:
            return m.Facts(self._readings())
        wait = waits.pop(self.chance.randrange(len(waits)))
        if isinstance(wait, m.SetTimer):
            return m.TimerFired(wait.timer)
        if isinstance(wait, m.AskPeople):
            return m.Answered(wait.question, self.chance.randint(*_whole_limits(wait.answer)))
        self._carry_out(wait)
        return m.TaskDone(wait.task)

    def _carry_out(self, ask: m.Ask) -> None:
        order = ask.order
        if order.role:
            self.roles[ROLE, order.role] = BATTERY[0]
        if order.kind in {"pick", "drop"}:
            quantity = order.quantity if order.kind == "pick" else -order.quantity
            if order.quantity < 1 or order.quantity != int(order.quantity):
                self.wrong = f"{order.kind} of {order.quantity}"
            self.carried += int(quantity)
            if not 0 <= self.carried <= CAPACITY:
                self.wrong = f"{order.kind} leaves {self.carried} at the step {order.step}"
        elif order.kind == "release":
            if self.carried:
                self.wrong = f"release of a robot that carries {self.carried} at the step {order.step}"
        elif order.kind == "call" and order.method == "curePaint":
            time = order.arguments.get("time")
            if not isinstance(time, int | float) or not LEAST_CURING_S <= time <= MOST_CURING_S:
                self.wrong = f"curing for {time} at the step {order.step}"


def _whole_limits(answer: AnswerSpec) -> tuple[int, int]:
    return int(answer.minimum or 0), int(3 if answer.maximum is None else answer.maximum)


def try_programs(count: int, seed: int, site: Surroundings) -> Iterator[tuple[Json, bool, str]]:
    """Yield programs, whether each checks clean, and what went wrong in one that does."""
    for number in range(count):
        document = make_program(seed * 1_000_003 + number)
        compiled = compile_document(document, site)
        told = {each.code for each in compiled.diagnostics} - HARMLESS
        if told or compiled.plan is None:
            yield document, False, ""
            continue
        chances = (random.Random(f"{number} {again}") for again in range(3))  # noqa: S311 - a sample, not a secret
        runs = (Judge(compiled.plan, chance).run() for chance in chances)
        yield document, True, next(filter(None, runs), "")


def main() -> int:
    """Try so many programs and tell what was found."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--programs", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    site = surroundings_from_json(json.loads(SITE.read_text()))
    clean = unsound = 0
    for document, is_clean, wrong in try_programs(given.programs, given.seed, site):
        clean += is_clean
        if wrong:
            unsound += 1
            sys.stdout.write(f"{wrong}\n{json.dumps(document)}\n{compile_document(document, site).script}\n")
    sys.stdout.write(f"{given.programs} programs, {clean} of them clean, {unsound} of these did what is not told.\n")
    return 1 if unsound else 0


if __name__ == "__main__":
    sys.exit(main())
