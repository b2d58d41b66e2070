"""What happens to a plant while its runs go on, one thing after the other, and how it is known to have passed."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from random import Random

import psycopg
import redis

from execution.fault_points import GATEWAY_POINTS, OWNER_POINTS
from tests.integration.breaking.chaos.plant import Plant

PAST_LEASE_S = 7.0
FROZEN_S = (PAST_LEASE_S, 20.0)
"""At a named point: past its lease, and so long that others have to end what it holds."""
LOOK_EVERY_S = 0.05
PATIENCE_S = 240.0
OUT_S = (0.0, 2.0)
CUT_S = (1.0, 5.0)


class Stuck(Exception):
    """Something that has to happen does not."""


@dataclass(frozen=True)
class Fault:
    """A thing that happens; `carry_out` returns when it has passed."""

    kind: str
    carry_out: Callable[[Plant, Random], None]
    arms: str = ""


def at_point(point: str, what: str) -> Fault:
    """Let the first process that comes to a point die there, or sleep past its lease."""

    def carry_out(plant: Plant, chance: Random) -> None:
        if point.endswith("hand_over"):
            _ask_to_go(plant)
        wait(plant, f"{what} at {point}", lambda: _is_passed(plant, point))
        if what == "freeze":
            wait(plant, f"{point} freezes", lambda: any(map(plant.is_frozen, plant.processes)))
            pause(plant, chance.choice(FROZEN_S))
            _thaw(plant)

    return Fault(f"{what} {point}", carry_out, point)


def _is_passed(plant: Plant, point: str) -> bool:
    """Tell whether somebody has come to a point; where all is done before that, more is given to do."""
    if not (plant.faults / point).exists():
        return True
    plant.allow_more()
    return False


def _ask_to_go(plant: Plant) -> None:
    owner: list[str] = []

    def is_there() -> bool:
        with suppress(psycopg.Error):
            owner.extend(filter(None, [plant.owner()]))
        return bool(owner)

    wait(plant, "an owner", is_there)
    plant.signal(owner[0], signal.SIGTERM)


def _thaw(plant: Plant) -> None:
    for name in plant.processes:
        if plant.is_frozen(name):
            plant.signal(name, signal.SIGCONT)


def kill(name: str) -> Fault:
    def carry_out(plant: Plant, _chance: Random) -> None:
        plant.signal(name, signal.SIGKILL)
        plant.processes[name].wait()

    return Fault(f"kill {name.partition('-')[0]}", carry_out)


def freeze(name: str) -> Fault:
    def carry_out(plant: Plant, _chance: Random) -> None:
        plant.signal(name, signal.SIGSTOP)
        pause(plant, PAST_LEASE_S)
        plant.signal(name, signal.SIGCONT)

    return Fault(f"freeze {name.partition('-')[0]}", carry_out)


def _restart_redis(plant: Plant, chance: Random) -> None:
    plant.redis.kill()
    pause(plant, chance.uniform(*OUT_S))
    plant.redis.start()


def _flush_redis(plant: Plant, _chance: Random) -> None:
    with redis.Redis.from_url(plant.redis.url) as client:
        client.flushall()


def _restart_mosquitto(plant: Plant, chance: Random) -> None:
    plant.mosquitto.kill()
    pause(plant, chance.uniform(*OUT_S))
    plant.mosquitto.start()


def _restart_postgres(plant: Plant, chance: Random) -> None:
    plant.postgres.stop()
    pause(plant, chance.uniform(*OUT_S))
    plant.postgres.start()


def _cut_devices(plant: Plant, chance: Random) -> None:
    longest = 0.0
    for device in chance.sample(plant.game.all_devices, 3):
        seconds = chance.uniform(*CUT_S)
        plant.tell("devices", f"cut {device} {seconds}")
        longest = max(longest, seconds)
    pause(plant, longest)


def freeze_server(kind: str) -> Fault:
    """Let a server that everybody talks to say nothing for a while, and keep its connections."""

    def carry_out(plant: Plant, _chance: Random) -> None:
        server = plant.mosquitto.process if kind == "mosquitto" else plant.redis.process
        assert server is not None
        server.send_signal(signal.SIGSTOP)
        pause(plant, PAST_LEASE_S)
        server.send_signal(signal.SIGCONT)

    return Fault(f"freeze {kind}", carry_out)


NAMED = [at_point(point, what) for point in (*OWNER_POINTS, *GATEWAY_POINTS) for what in ("kill", "freeze")]
AT_RANDOM = [
    *map(kill, ("worker-1", "worker-2", "gateway-1", "gateway-2", "ticker", "load", "devices")),
    *map(freeze, ("worker-1", "worker-2", "gateway-1", "gateway-2", "ticker", "devices")),
    *map(freeze_server, ("redis", "mosquitto")),
    Fault("restart redis", _restart_redis),
    Fault("flush redis", _flush_redis),
    Fault("restart mosquitto", _restart_mosquitto),
    Fault("restart postgres", _restart_postgres),
    Fault("cut devices", _cut_devices),
]


def pause(plant: Plant, seconds: float) -> None:
    """Let time pass, in which what ends is started again."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        plant.supervise()
        time.sleep(LOOK_EVERY_S)


def wait(plant: Plant, what: str, ready: Callable[[], bool], limit_s: float = PATIENCE_S) -> None:
    """Wait for something; raises Stuck."""
    until = time.monotonic() + limit_s
    while not ready():
        if time.monotonic() > until:
            raise Stuck(f"{what} did not come within {limit_s:g} s")
        plant.supervise()
        time.sleep(LOOK_EVERY_S)


def choose(seed: int, count: int) -> Iterator[Fault]:
    """Yield every named point and every kind once, mixed, and then by chance; at most `count` of them."""
    chance, mixed = Random(seed), [*NAMED, *AT_RANDOM]
    chance.shuffle(mixed)
    yield from mixed[:count]
    for _ in range(count - len(mixed)):
        yield chance.choice(AT_RANDOM)
