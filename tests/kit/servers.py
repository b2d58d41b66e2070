"""Real PostgreSQL, Redis and Mosquitto for tests: each on a free port, in a folder of its own, ended after use.

with run_redis(folder) as redis: ...            redis.url
with run_postgres(folder) as postgres: ...      postgres.url
with run_mosquitto(folder, {"server": "secret"}) as mosquitto: ...   mosquitto.port, .device_port, .authority
"""

from __future__ import annotations

import itertools
import os
import platform
import pwd
import secrets
import shutil
import socket
import subprocess
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import NoReturn

import pytest

from registry.broker.mosquitto_file import EVERY_SITE, account_file
from tests.kit.files import ROOT
from tests.kit.waiting import PATIENCE_S, wait_for
from vipo_device.protocol.credentials import broker_hash

FIRST_PORT, PORTS_EACH = 16_000, 2_000


def free_port() -> int:
    """Return a port that nothing listens on, and that neither a connection nor another runner of tests takes meanwhile.

    Servers stop and start again on their port. So ports lie below those that the system gives to connections, and each
    of the processes that run tests side by side has a range of its own.
    """
    for port in itertools.islice(_PORTS, PORTS_EACH):
        with socket.socket() as probe, suppress(OSError):
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(("127.0.0.1", port))
            return port
    raise AssertionError("All ports for tests are in use.")


def _own_ports() -> Iterator[int]:
    """Yield the ports of this process, round and round, beginning somewhere: others may run tests on this machine."""
    worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
    own = range(FIRST_PORT + worker * PORTS_EACH, FIRST_PORT + (worker + 1) * PORTS_EACH)
    start = secrets.randbelow(PORTS_EACH)
    return itertools.cycle([*own[start:], *own[:start]])


_PORTS = _own_ports()


def answers(port: int) -> bool:
    """Tell whether something accepts connections on the port."""
    with suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=1):
        return True
    return False


START_LIMIT_S = 120.0


class ServerMissing(AssertionError):
    """A server program is not installed; the message says how to get it."""


@dataclass
class Postgres:
    """A running PostgreSQL with one database, empty at first."""

    url: str
    port: int
    data: Path
    log: Path
    options: list[str]
    process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Start (again), on the same port and with what it kept."""
        command = [*plain_user(), str(postgres_programs() / "postgres"), "-D", f"{self.data}/db", *self.options]
        with self.log.open("ab") as out:
            self.process = subprocess.Popen(command, stdout=out, stderr=out, cwd="/")
        ask = [str(postgres_programs() / "pg_isready"), "-q", "-h", "127.0.0.1", "-p", str(self.port)]
        wait_ready(lambda: subprocess.run(ask).returncode == 0, self.log.read_text, self.process)

    def stop(self) -> None:
        """End it at once, as a crash would: what was committed is found in its log at the next start."""
        control = [*plain_user(), str(postgres_programs() / "pg_ctl"), "-D", f"{self.data}/db"]
        stop = [*control, "-m", "immediate", "-w", "stop"]
        subprocess.run(stop, capture_output=True, cwd="/")
        if self.process is not None:
            self.process.wait(PATIENCE_S)


@dataclass
class Redis:
    """A running Redis."""

    url: str
    port: int
    folder: Path
    process: subprocess.Popen[bytes] = field(init=False)

    def start(self) -> None:
        """Start (again), on the same port and empty."""
        alone = ["--bind", "127.0.0.1", "--save", "", "--appendonly", "no", "--dir", str(self.folder)]
        log = self.folder / "redis.log"
        with log.open("ab") as out:
            command = [find_program("redis-server"), "--port", str(self.port), *alone]
            self.process = subprocess.Popen(command, stdout=out, stderr=out)
        wait_ready(lambda: answers(self.port), log.read_text, self.process)

    def kill(self) -> None:
        """End it without warning."""
        self.process.kill()
        self.process.wait()


@dataclass
class Mosquitto:
    """A running Mosquitto with the product's own configuration; `port` is the server's, `device_port` the devices'."""

    port: int
    device_port: int
    folder: Path
    authority: str = ""
    process: subprocess.Popen[bytes] | None = None
    accounts: dict[str, str] = field(default_factory=dict)

    def start(self) -> None:
        """Start (again), on the same ports and with what it kept."""
        program = find_program("mosquitto", "/usr/sbin/mosquitto")
        with (self.folder / "mosquitto.log").open("ab") as log:
            self.process = subprocess.Popen([program, "-c", self.folder / "mosquitto.conf"], stdout=log, stderr=log)
        wait_ready(lambda: answers(self.port) and answers(self.device_port), self._story, self.process)

    def kill(self) -> None:
        """End it without warning, as a power cut would."""
        assert self.process is not None
        self.process.kill()
        self.process.wait()

    def stop(self) -> None:
        """End it properly; what it keeps is written."""
        if self.process is not None and self.process.poll() is None:
            self.process.terminate()
            self.process.wait(PATIENCE_S)

    def _story(self) -> str:
        return (self.folder / "mosquitto.log").read_text()


def must_be_installed(what: str, why: str) -> NoReturn:
    """Fail over a part that is missing, with the command that installs it; skip where that command cannot.

    ROS 1 and MicroPython come as Debian's packages.
    """
    with suppress(OSError):
        if platform.freedesktop_os_release().get("ID") == "debian":
            raise ServerMissing(f"{what} is not here: {why} Run `make servers`, then try again.")
    pytest.skip(f"{what} comes from Debian's packages, which this system does not have: {why}")


def find_program(name: str, *places: str) -> str:
    """Return a program's path, or say how to get it."""
    found = shutil.which(name) or next((place for place in places if Path(place).exists()), None)
    if found is None:
        raise ServerMissing(f"{name} is not installed. Run scripts/install-test-servers.sh (or `make servers`).")
    return found


def find_plugin() -> str:
    """Return the path of Mosquitto's dynamic security plugin, which comes with it."""
    found = [*Path("/usr/lib").glob("*/mosquitto_dynamic_security.so"), *Path("/usr/lib").glob("mosquitto_dynamic*.so")]
    if not found:
        raise ServerMissing("Mosquitto's plugin is missing. Run scripts/install-test-servers.sh (or `make servers`).")
    return str(found[0])


def wait_ready(ready: Callable[[], bool], story: Callable[[], str], process: subprocess.Popen[bytes]) -> None:
    """Wait for a server; when it ends or takes too long, fail with what it wrote."""

    def ended() -> str:
        return "" if process.poll() is None else f"it ended with code {process.returncode}"

    wait_for("the server's answer", ready, START_LIMIT_S, story=story, hopeless=ended)


def plain_user() -> list[str]:
    """Return how to become the user `postgres`, since PostgreSQL refuses to run as root; empty for a plain user."""
    if os.geteuid() != 0:
        return []
    try:
        pwd.getpwnam("postgres")
    except KeyError:
        raise ServerMissing("There is no user postgres. Run scripts/install-test-servers.sh.") from None
    return ["runuser", "-u", "postgres", "--"]


def postgres_programs() -> Path:
    """Return the folder of the newest PostgreSQL."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"), key=lambda path: float(path.parts[-3]))
    if not found:
        raise ServerMissing("PostgreSQL is not installed. Run scripts/install-test-servers.sh (or `make servers`).")
    return found[-1].parent


@contextmanager
def run_postgres(folder: Path, *, keep_durable: bool = False) -> Iterator[Postgres]:
    """Run PostgreSQL with the database `vipo`; not durable unless asked, since tests do not pull the plug."""
    programs, become, port = postgres_programs(), plain_user(), free_port()
    # The server's own user cannot enter pytest's folders, which belong to the one who runs the tests.
    made_folder = subprocess.run([*become, "mktemp", "-d", "/tmp/vipo-pg.XXXXXX"], capture_output=True, check=True)
    data = Path(made_folder.stdout.decode().strip())
    options = f"-p {port} -k {data} -c listen_addresses=127.0.0.1 -c max_connections=60 -c shared_buffers=32MB"
    options += "" if keep_durable else " -c fsync=off -c synchronous_commit=off -c full_page_writes=off"
    url = f"postgresql://vipo@127.0.0.1:{port}/vipo"
    server = Postgres(url, port, data, folder / "postgres.log", options.split())
    try:
        make = [*become, str(programs / "initdb"), "-D", f"{data}/db", "-U", "vipo"]
        plain = ["-A", "trust", "-E", "UTF8", "--locale=C", "-N"]
        subprocess.run([*make, *plain], capture_output=True, check=True, cwd="/")
        server.start()
        create = [str(programs / "createdb"), "-h", "127.0.0.1", "-p", str(port), "-U", "vipo", "vipo"]
        subprocess.run(create, capture_output=True, check=True)
        yield server
    finally:
        server.stop()
        subprocess.run([*become, "rm", "-rf", data], check=False)


@contextmanager
def run_redis(folder: Path) -> Iterator[Redis]:
    """Run Redis without persistence."""
    port = free_port()
    server = Redis(f"redis://127.0.0.1:{port}/0", port, folder)
    server.start()
    try:
        yield server
    finally:
        server.process.terminate()
        server.process.wait(PATIENCE_S)


@contextmanager
def run_mosquitto(folder: Path, accounts: Mapping[str, str], *, tls: bool = False) -> Iterator[Mosquitto]:
    """Run Mosquitto with deploy/mosquitto's configuration and rules for {user name: password}."""
    server = Mosquitto(free_port(), free_port(), folder, accounts=dict(accounts))
    if tls:
        script = ROOT / "deploy" / "mosquitto" / "make-certificates.sh"
        subprocess.run([script, folder, "localhost", "127.0.0.1"], check=True, capture_output=True)
        server.authority = str(folder / "ca.crt")
    write_mosquitto_files(server)
    server.start()
    try:
        yield server
    finally:
        server.stop()


def write_mosquitto_files(server: Mosquitto) -> None:
    """Write the configuration with this test's paths and ports, and the files that it names."""
    folder = server.folder
    hashes = {name: broker_hash(word) for name, word in server.accounts.items()}
    accounts = account_file(hashes, dict.fromkeys(hashes, EVERY_SITE), server="server")
    (folder / "dynamic-security.json").write_text(accounts)
    text = (ROOT / "deploy" / "mosquitto" / "mosquitto.conf").read_text()
    for old, new in {
        "/usr/lib/mosquitto_dynamic_security.so": find_plugin(),
        "/mosquitto/config/": f"{folder}/",
        "/run/secrets/broker-authority": f"{folder}/ca.crt",
        "/run/secrets/broker-certificate": f"{folder}/server.crt",
        "/run/secrets/broker-key": f"{folder}/server.key",
        "/mosquitto/data/": f"{folder}/",
        "listener 8883": f"listener {server.device_port} 127.0.0.1",
        "listener 8884": f"listener {server.port} 127.0.0.1",
    }.items():
        assert old in text, f"deploy/mosquitto/mosquitto.conf has no {old!r} any more"
        text = text.replace(old, new)
    if not server.authority:
        certificates = ("cafile", "certfile", "keyfile", "tls_version")
        text = "\n".join(line for line in text.splitlines() if not line.startswith(certificates))
    if os.geteuid() == 0:
        text += "\nuser root\n"
    (folder / "mosquitto.conf").write_text(text)
