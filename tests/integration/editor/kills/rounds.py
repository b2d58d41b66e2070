"""People at two web processes draw while one of them ends; a judge says what was called saved and is not there.

`python -m scripts.room_kills 1000 [SEED]` does so often enough to believe it.
A round is one program with a person at each process; several are drawn at once, and one kill ends all of them.
"""

from __future__ import annotations

import random
import signal
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import psycopg
import redis

from editor.documents.shared_document import SharedDocument
from tests.integration.editor.node_clients import NodeClients, node_process
from tests.integration.editor.web_pairs import Pair
from tests.kit.waiting import PATIENCE_S
from tests.kit.web import Web

AT_ONCE = 5
ALIKE_WITHIN_S = 60.0
EMPTIED = 0.3
"""How often Redis loses what it has shortly before the end: all of it, what the rooms told, or all but the last."""
ENDS = ("killed", "killed", "killed", "told to end", "frozen")
"""How a process ends; the one that is frozen goes on when the other has been judged."""
LONGEST_S = 0.8
"""How long people draw before the kill at most: several times as long as changes wait for their rows."""


@dataclass
class Judged:
    """What came of rounds: how many changes were called saved, and which of them were not there."""

    rounds: int = 0
    saved: int = 0
    lost: int = 0
    examples: tuple[str, ...] = ()


def play(pair: Pair, rounds: int, seed: int) -> Iterator[Judged]:
    """Play so many rounds; yields what is judged so far after each kill. Both processes run before and afterwards."""
    dice, judged = random.Random(seed), Judged()
    while judged.rounds < rounds:
        count = min(AT_ONCE, rounds - judged.rounds)
        _kill_once(pair, count, dice, judged)
        yield judged


def _kill_once(pair: Pair, count: int, dice: random.Random, judged: Judged) -> None:
    (victim, other), how = dice.sample([pair.one, pair.two], 2), dice.choice(ENDS)
    programs = [other.new_program() for _ in range(count)]
    with node_process(other, Path(__file__).with_name("kill_clients.mjs")) as people:
        for number, program in enumerate(programs):
            for web in (victim, other):
                name = f"p{number}{'v' if web is victim else 'o'}"
                session = web.sessions["author" if web is victim else "second"]
                people.tell("open", name=name, program=program, session=session, port=web.port)
        people.tell("draw", everyMs=dice.choice([10, 30, 80]))
        time.sleep(dice.random() * LONGEST_S)
        if dice.random() < EMPTIED:
            _empty(pair.redis.url, dice)
            time.sleep(dice.random() * LONGEST_S / 4)
        _end(victim, how)
        people.tell("stop")
        kept = people.tell("acknowledged")["people"]
        if dice.random() < 0.5:  # the browsers of the dead process are closed, so nobody can say it again
            people.tell("leave", names=[each["name"] for each in kept if each["name"].endswith("v")])
        _judge(kept, {program: _stored_steps(pair, program) for program in programs}, judged)
        _begin(victim, how)
        drawn = people.tell("settled")["steps"]
        _judge(kept, drawn, judged)
        for program in programs:
            _judge_alike(pair, people, program, judged)
    judged.rounds += count


def _empty(url: str, dice: random.Random) -> None:
    with redis.Redis.from_url(url) as connection:
        keys = list(connection.scan_iter("vipo:room:*"))
        match dice.choice(("flushed", "expired", "trimmed")):
            case "flushed":
                connection.flushall()
            case "expired" if keys:
                connection.delete(*keys)
            case _:
                for key in keys:
                    connection.xtrim(key, maxlen=dice.randrange(3), approximate=False)


def _end(web: Web, how: str) -> None:
    assert web.process is not None
    match how:
        case "killed":
            web.kill()
        case "told to end":
            web.process.terminate()
            web.process.wait(PATIENCE_S)
        case _:
            web.process.send_signal(signal.SIGSTOP)


def _begin(web: Web, how: str) -> None:
    assert web.process is not None
    if how == "frozen":
        web.process.send_signal(signal.SIGCONT)
    else:
        web.start()


def _judge_alike(pair: Pair, people: NodeClients, program: str, judged: Judged) -> None:
    """Compare what is shown with the rows; of rows that the dead process told nobody, a room learns within seconds."""
    ends = time.monotonic() + ALIKE_WITHIN_S
    while (shown := people.tell("settled")["steps"][program]) != (stored := _stored_steps(pair, program)):
        if time.monotonic() > ends:
            _note_loss(judged, f"{program}: shown {shown}, stored {stored}")
            return
        time.sleep(0.2)


def _stored_steps(pair: Pair, program: str) -> dict[str, Any]:
    """Read the rows themselves: whoever asks a process has it write what it still holds."""
    with psycopg.connect(pair.database_url) as connection:
        rows = [
            bytes(data)
            for table in ("editor_snapshot", "editor_documentupdate")
            for (data,) in connection.execute(f"SELECT data FROM {table} WHERE program_id = %s ORDER BY seq", [program])
        ]
    steps: dict[str, Any] = SharedDocument(rows).to_json()["steps"]
    return steps


def _judge(kept: list[dict[str, Any]], stored: dict[str, dict[str, Any]], judged: Judged) -> None:
    """Compare what was called saved with what is there: each step as it was then, or as it became later."""
    for person in kept:
        for step, history in person["history"].items():
            saved = [number for number, (made, _) in enumerate(history) if made <= person["savedAt"]]
            if saved:
                judged.saved += len(saved)
                there = stored[person["program"]].get(step)
                if there not in [value for _, value in history[saved[-1] :]]:
                    _note_loss(judged, f"{person['name']} {step}: {history} saved to {person['savedAt']}, is {there}")


def _note_loss(judged: Judged, words: str) -> None:
    judged.lost += 1
    judged.examples = (*judged.examples, words)[:5]
