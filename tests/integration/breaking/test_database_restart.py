"""PostgreSQL crashes under a gateway with traffic, connections are cut, Redis restarts: nothing said is lost."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from uuid import UUID, uuid4

import psycopg
import pytest
from django.core.management import call_command
from django.db import connection, transaction
from pytest_django import DjangoDbBlocker

from execution import services as execution
from execution.models import Command
from registry import services
from registry.live.fanout import make_live
from registry.models import Device, DeviceEvent, Site
from tests.kit.databases import on_database
from tests.kit.files import MIXER_TEXT, ROOT
from tests.kit.mqtt import Ear
from tests.kit.processes.forked import ForkedPython
from tests.kit.served import settings_for
from tests.kit.servers import Mosquitto, Postgres, Redis, run_mosquitto, run_postgres, run_redis
from tests.kit.waiting import wait_for
from vipo_site.settings import postgres as described_in

pytestmark = pytest.mark.servers
SITE, WORD = "painting-factory", "the server's word"
NAMES = tuple(f"mixer{number:02}" for number in range(1, 6))
FLOOD, FLOOD_KB = 4000, 8
AWAY = "The database does not answer"


@dataclass
class Plant:
    """The servers, one gateway as a process, and an ear that also speaks for the devices."""

    postgres: Postgres
    redis: Redis
    mosquitto: Mosquitto
    environment: dict[str, str]
    log: Path
    ear: Ear
    processes: list[subprocess.Popen[bytes]] = field(default_factory=list)
    seq: int = 0

    def start_gateway(self) -> None:
        self.ear.forget()
        with self.log.open("ab") as log:
            command = [sys.executable, "manage.py", "gateway"]
            self.processes.append(ForkedPython(command, cwd=ROOT, env=self.environment, stdout=log, stderr=log))

    def wait_greeting(self) -> None:
        self.ear.wait(lambda heard: heard.topic == "vipo/v1/srv/status" and not heard.retained, 60)

    @contextmanager
    def frozen_gateway(self) -> Iterator[None]:
        """Let the gateway do nothing more, so that another takes its session over at once, and kill it afterwards."""
        process = self.processes.pop()
        process.send_signal(signal.SIGSTOP)
        try:
            yield
        finally:
            process.kill()
            process.wait()

    @contextmanager
    def without_database(self) -> Iterator[None]:
        """Let PostgreSQL crash, and come back afterwards."""
        connection.close()
        self.postgres.stop()
        try:
            yield
        finally:
            self.postgres.start()

    def memory_mb(self) -> float:
        lines = Path(f"/proc/{self.processes[-1].pid}/status").read_text().splitlines()
        return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS")) / 1024

    def log_lines(self, text: str) -> int:
        return self.log.read_text().count(text)

    def say(self, device: str, kind: str, body: object, *, retain: bool = False) -> None:
        self.ear.say(f"vipo/v1/dev/{device}/up/{kind}", body, retain=retain)

    def describe(self, *titles: str) -> None:
        for name in NAMES:
            for title in titles:
                text = MIXER_TEXT.replace("paintMixer03", name).replace(f'title "{name}"', f'title "{title}"')
                self.say(name, "desc", text.encode(), retain=True)

    def say_states(self, count: int) -> None:
        for _ in range(count):
            self.seq += 1
            for name in NAMES:
                state = {"boot": 1, "seq": self.seq, "done": True, "props": {"jobStatus": self.seq}}
                self.say(name, "state", state, retain=True)

    def answer(self, commands: dict[str, UUID]) -> None:
        for device, command in commands.items():
            for status in ("ACCEPTED", "RUNNING", "DONE"):
                self.say(device, "ack", {"id": str(command), "st": status})

    def flood(self) -> None:
        """Say much for devices that nobody knows; only its size matters."""
        note = "x" * 250
        for number in range(FLOOD):
            props = {f"note{each}": note for each in range(4 * FLOOD_KB)}
            self.say(f"flood{number % 40}", "state", {"boot": 1, "seq": number, "done": True, "props": props})

    def wait_kept(self, title: str) -> None:
        """Wait until every device has its last description and its last state."""
        last = {(name, title, self.seq, self.seq) for name in NAMES}

        def kept() -> bool:
            devices = services.list_devices(site=SITE)
            rows = {row.pk: row.seq for row in Device.objects.filter(pk__in=NAMES)}
            return {(d.id, d.name, rows[d.id], d.readings.get("jobStatus")) for d in devices} == last

        wait_for(f"{title}, {self.seq}", kept)


def add_command(device: str, *, due_in_s: float) -> UUID:
    now = datetime.now(UTC)
    return Command.objects.create(
        id=uuid4(),
        site=Site.objects.get(slug=SITE),
        position=Command.objects.count() + 1,
        device=device,
        method="mixPaint",
        arguments={"time": 1},
        created_at=now,
        send_after=now + timedelta(seconds=due_in_s),
    ).id


def wait_heard(plant: Plant, commands: dict[str, UUID]) -> None:
    for device, command in commands.items():
        topic = f"vipo/v1/dev/{device}/down/mixPaint"
        plant.ear.wait(lambda h, t=topic, c=command: h.topic == t and h.json["id"] == str(c), 60)


def statuses(commands: dict[str, UUID]) -> set[str]:
    return set(Command.objects.filter(id__in=commands.values()).values_list("status", flat=True))


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory, django_db_blocker: DjangoDbBlocker) -> Iterator[Plant]:
    folder = tmp_path_factory.mktemp("plant")
    (folder / "state").mkdir()
    with ExitStack() as stack:
        postgres = stack.enter_context(run_postgres(folder, keep_durable=True))
        redis = stack.enter_context(run_redis(folder))
        mosquitto = stack.enter_context(run_mosquitto(folder, {"server": WORD}))
        environment = settings_for(folder / "state", postgres.url, redis.url, mosquitto)
        environment |= {"VIPO_MQTT_TLS": "0", "VIPO_LOG": "WARNING", "VIPO_DEFAULT_SITE": SITE}
        stack.enter_context(django_db_blocker.unblock())
        stack.enter_context(on_database(**described_in(postgres.url)))
        ear = Ear(mosquitto.port, WORD, "vipo/v1/dev/+/down/#")
        ear.client.subscribe("vipo/v1/srv/status", 1, ear._take)
        stack.enter_context(ear)
        plant = Plant(postgres, redis, mosquitto, environment, folder / "gateway.log", ear)
        prepare()
        plant.start_gateway()
        stack.callback(lambda: plant.processes[-1].wait(30))
        stack.callback(lambda: plant.processes[-1].terminate())
        plant.wait_greeting()
        yield plant


def prepare() -> None:
    call_command("migrate", verbosity=0, interactive=False)
    services.create_site(name="Hall", slug=SITE)
    for name in NAMES:
        text = MIXER_TEXT.replace("paintMixer03", name)
        services.ingest_description(device_id=name, payload=text.encode(), at=datetime.now(UTC))
    Device.objects.update(lifecycle="approved", site=Site.objects.get(slug=SITE))


def test_what_is_said_while_the_database_is_away_is_kept_in_order_and_commands_go_out_afterwards(plant: Plant) -> None:
    open_ones = {name: add_command(name, due_in_s=0) for name in NAMES}
    wait_heard(plant, open_ones)
    waiting = {name: add_command(name, due_in_s=2) for name in NAMES}
    before_mb = plant.memory_mb()
    with plant.without_database():
        plant.describe("First", "Second")
        plant.answer(open_ones)
        plant.say_states(20)
        plant.flood()
        wait_for("the outage in the log", lambda: plant.log_lines(AWAY) >= 1)
        wait_for("the flood at the broker", lambda: not plant.ear.client._paho._out_messages)
        assert plant.memory_mb() - before_mb < FLOOD * FLOOD_KB / 1024 / 2
    plant.wait_kept("Second")
    wait_for("the answers", lambda: statuses(open_ones) == {"done"})
    wait_heard(plant, waiting)
    for name in NAMES:
        events = DeviceEvent.objects.filter(device=name, kind="described").order_by("pk")
        changes = [change for changes in events.values_list("changes", flat=True) for change in changes]
        assert [c["after"] for c in changes if c["before"] in (f'"{name}"', '"First"')] == ['"First"', '"Second"']
    # One thread's question from before may fail after another's was answered: that is told as a second time.
    wait_for("the end of it in the log", lambda: plant.log_lines("The database answers again") == plant.log_lines(AWAY))
    assert 1 <= plant.log_lines(AWAY) <= 2
    assert plant.log_lines("Traceback") == 0


def test_nothing_was_acknowledged_to_the_broker_before_it_was_kept(plant: Plant) -> None:
    open_ones = {name: add_command(name, due_in_s=0) for name in NAMES}
    wait_heard(plant, open_ones)
    before = plant.log_lines(AWAY)
    with ExitStack() as stack:
        with plant.without_database():
            plant.answer(open_ones)
            plant.describe("Third")
            plant.say_states(20)
            wait_for("the outage in the log", lambda: plant.log_lines(AWAY) > before)
            stack.enter_context(plant.frozen_gateway())
            plant.start_gateway()
        plant.wait_greeting()
    plant.wait_kept("Third")
    wait_for("the answers", lambda: statuses(open_ones) == {"done"})


def test_a_connection_that_is_cut_is_made_anew(plant: Plant) -> None:
    plant.describe("Third")
    plant.say_states(1)
    plant.wait_kept("Third")
    connection.close()
    with psycopg.connect(plant.postgres.url, autocommit=True) as other:
        others = "FROM pg_stat_activity WHERE datname = 'vipo' AND pid <> pg_backend_pid()"
        others += " AND backend_type = 'client backend'"

        def are_all_there() -> bool:
            return len(other.execute(f"SELECT pid {others}").fetchall()) == 4

        wait_for("what comes in, what goes out, what dashboards are told, the heartbeat", are_all_there)
        assert len(other.execute(f"SELECT pg_terminate_backend(pid) {others}").fetchall()) == 4
    plant.describe("Fourth")
    plant.say_states(1)
    plant.wait_kept("Fourth")
    commands = {name: add_command(name, due_in_s=0) for name in NAMES}
    wait_heard(plant, commands)


def claim_until_none_is_left(ids: set[str], taken: list[str]) -> None:
    def none_is_left() -> bool:
        taken.extend(command.id for command in execution.claim_commands(limit=3))
        return not Command.objects.filter(id__in=ids, tries=0).exists()

    try:
        wait_for("the end of the claims", none_is_left, every_s=0)
    finally:
        connection.close()


def test_each_command_goes_to_one_of_three_that_claim_at_the_same_time(plant: Plant) -> None:
    Command.objects.update(status="done")
    Device.objects.filter(pk__in=NAMES).update(source_type="text/plain")  # by the paper's message: never told twice
    ids = {str(add_command(NAMES[number % len(NAMES)], due_in_s=1)) for number in range(50)}
    taken: list[list[str]] = [[], []]
    threads = [threading.Thread(target=claim_until_none_is_left, args=(ids, mine)) for mine in taken]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()

    def claimed() -> list[str]:
        heard = (message.json["id"] for message in plant.ear.all("/mixPaint"))
        return sorted([*taken[0], *taken[1], *(each for each in heard if each in ids)])

    wait_for("every command", lambda: set(claimed()) == ids)
    assert claimed() == sorted(ids)
    assert set(Command.objects.filter(id__in=ids).values_list("tries", flat=True)) == {1}
    Command.objects.filter(id__in=ids).update(status="done")
    Device.objects.filter(pk__in=NAMES).update(source_type="text/turtle")


@pytest.mark.parametrize(("form", "waits"), [("text/turtle", "off"), ("text/plain", "on")])
def test_a_claim_waits_for_the_disk_only_where_a_device_would_do_it_twice(plant: Plant, form: str, waits: str) -> None:
    Device.objects.filter(pk__in=NAMES).update(source_type=form)
    with transaction.atomic(), connection.cursor() as cursor:
        ids = {str(add_command(name, due_in_s=0)) for name in NAMES}  # which the gateway does not see
        assert {command.id for command in execution.claim_commands(limit=100)} == ids
        assert cursor.execute("SHOW synchronous_commit").fetchone() == (waits,)
        transaction.set_rollback(True)
    Device.objects.filter(pk__in=NAMES).update(source_type="text/turtle")


def test_live_news_and_hints_come_back_with_redis(plant: Plant) -> None:
    news: list[str] = []
    live = make_live(plant.redis.url)
    live.listen(lambda _slug, message: news.append(json.dumps(message)))
    plant.describe("Fifth")
    plant.say_states(1)
    plant.wait_kept("Fifth")
    plant.redis.kill()
    plant.say_states(20)
    plant.wait_kept("Fifth")
    commands = {name: add_command(name, due_in_s=0) for name in NAMES}
    wait_heard(plant, commands)
    plant.redis.start()
    wait_for("a hello", lambda: any('"hello"' in told for told in news))
    news.clear()

    def is_told() -> bool:
        plant.say_states(1)
        return any('"device"' in told for told in news)

    wait_for("a device's news", is_told)

    def is_woken() -> bool:
        live.wake("gateway")
        return live.wait_wake("gateway", 0.1)

    wait_for("the hint", is_woken)
    live.close()
    # One thread's question from before may fail after another's was answered: that is told as a second time.
    wait_for("the end of it in the log", lambda: plant.log_lines("Redis answers again") == told_away(plant))
    assert 1 <= told_away(plant) <= 2


def told_away(plant: Plant) -> int:
    return plant.log_lines("Redis does not answer")
