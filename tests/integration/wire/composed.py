"""What docker-compose.yml starts, as processes of this machine: the same commands, settings and configuration.

Each service has an address of its own out of 127.0.0.0/8, so that ports stay what they are; names of services become
those addresses, and paths of containers become folders of the test. A service is given the secrets that it lists and
no others. PostgreSQL is the kit's, with the deployment's password, for its image's start-up script is not here.
"""

from __future__ import annotations

import json
import os
import re
import secrets
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import psycopg
import yaml
from psycopg import sql

from tests.kit.files import ROOT
from tests.kit.served import wait_or_kill
from tests.kit.servers import Postgres, find_plugin, find_program, run_postgres
from tests.kit.waiting import wait_for

PLACES = {"redis": 6, "mosquitto": 7, "proxy": 10, "web-1": 11, "web-2": 12, "stranger": 99}
STARTED = (
    "redis",
    "setup",
    "accounts",
    "mosquitto",
    "web-1",
    "web-2",
    "proxy",
    "gateway",
    "worker-1",
    "rehearsals",
    "ticker",
    "mirror",
    "stand-ins",
)
FOLDERS = {"/state": "state", "/archive": "archive", "/mosquitto/": "broker/", "/data": "redis"}
"""Paths of containers, and which folders of the test they are for who mounts something there."""
CLOSED = "/proc"
"""Where folders stand that are not mounted: they are empty, and nobody, not even root, can write there."""
PROGRAMS = {"python": [], "celery": ["-m", "celery"], "daphne": ["-m", "daphne"]}
FIRST_NAME = "vipo.example"


@dataclass
class Composed:
    """The deployment: its folder, what its compose file says, and its running processes."""

    folder: Path
    network: str
    postgres: Postgres
    said: dict[str, Any] = field(default_factory=dict)
    processes: dict[str, subprocess.Popen[bytes]] = field(default_factory=dict)

    def address(self, service: str) -> str:
        return f"{self.network}.{PLACES[service]}"

    @property
    def site(self) -> Path:
        return self.folder / "site"

    @property
    def url(self) -> str:
        return f"https://{self.address('proxy')}:8443"

    def place(self, service: str, text: str) -> str:
        """Return a text of the deployment with this machine's paths and addresses."""
        given = self.said["services"][service].get("secrets", ())
        paths = {f"/run/secrets/{name}": str(self.site / self.said["secrets"][name]["file"]) for name in given}
        mounts = [volume.split(":")[1] for volume in self.said["services"][service].get("volumes", ())]
        for inside, outside in FOLDERS.items():
            is_mounted = any(mount.startswith(inside) for mount in mounts)
            paths[inside] = f"{self.folder}/{outside}" if is_mounted else f"{CLOSED}{inside}"
        paths |= {"/tmp/": f"{self.folder}/tmp-{service}/"}
        # all at once, for the paths of the test begin like those of a container
        known = "|".join(re.escape(path) for path in sorted(paths, key=len, reverse=True))
        text = re.sub(rf"(?<![\w/.-])({known})", lambda match: paths[match[1]], text)
        text = text.replace("@postgres:5432/", f"@127.0.0.1:{self.postgres.port}/")
        return re.sub(r"(?<![\w.-])(redis|web-[12]):(\d)", lambda m: f"{self.address(m[1])}:{m[2]}", text)

    def environment(self, service: str) -> dict[str, str]:
        own = {name: value for name, value in os.environ.items() if not name.startswith(("VIPO_", "DJANGO_"))}
        named: dict[str, str] = self.said["services"][service].get("environment", {})
        placed = {name: self.place(service, value) for name, value in named.items()}
        if "VIPO_MODE" in placed:
            # what nginx connects from on this machine, and where the broker is
            placed |= {"VIPO_PROXIES": "127.0.0.1", "VIPO_MQTT_HOST": self.address("mosquitto")}
        return own | placed | {"DJANGO_SETTINGS_MODULE": "vipo_site.settings", "PYTHONUNBUFFERED": "1"}

    def command(self, service: str) -> list[str]:
        """Return what the service runs, by the compose file or else by the image."""
        image = re.search(r"^CMD (\[.*\])$", (ROOT / "Dockerfile").read_text(), re.MULTILINE)
        assert image is not None
        words = self.said["services"][service].get("command") or json.loads(image[1])
        program, *rest = [self.place(service, word) for word in words]
        if program in PROGRAMS:
            here = [self.address(service) if word == "0.0.0.0" else word for word in rest]
            return [sys.executable, *PROGRAMS[program], *here]
        if service == "redis":
            return [program, *rest[:-1], f"{rest[-1].strip()} --port 6379 --bind {self.address('redis')}"]
        kept = {"mosquitto": "mosquitto.conf", "proxy": "nginx.conf"}[service]
        path = find_program(program, f"/usr/sbin/{program}")
        return [path, "-c", str(self.folder / kept), *(rest if service == "proxy" else [])]

    def start(self, service: str) -> subprocess.Popen[bytes]:
        (self.folder / f"tmp-{service}").mkdir(exist_ok=True)
        with self.log(service).open("ab") as log:
            self.processes[service] = subprocess.Popen(
                self.command(service), cwd=ROOT, env=self.environment(service), stdout=log, stderr=log
            )
        return self.processes[service]

    def vipo(self, *arguments: str) -> str:
        """Run `vipo` in the container of a web process."""
        command = [sys.executable, "-m", "vipo_site.cli.main", *arguments]
        done = subprocess.run(command, cwd=ROOT, env=self.environment("web-1"), capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    def log(self, service: str) -> Path:
        return self.folder / f"{service}.log"

    def story(self) -> str:
        logs = sorted(self.folder.glob("*.log"))
        return "\n".join(f"--- {log.name}\n{chr(10).join(log.read_text().splitlines()[-12:])}" for log in logs)

    def stop_all(self) -> None:
        for process in self.processes.values():
            with suppress(ProcessLookupError):
                process.terminate()
        for process in self.processes.values():
            wait_or_kill(process)


@contextmanager
def running_composed(folder: Path) -> Iterator[Composed]:
    """Set the deployment up as docs/operations.md says, and start what its compose file names without a profile."""
    network = f"127.{secrets.randbelow(200) + 20}.{secrets.randbelow(250) + 1}"
    with ExitStack() as stack:
        composed = Composed(folder, network, stack.enter_context(run_postgres(folder)))
        set_up(composed)
        write_configurations(composed)
        protect_database(composed)
        stack.callback(composed.stop_all)
        for service in STARTED:
            process = composed.start(service)
            if composed.said["services"][service].get("restart") == "no":
                assert process.wait(240) == 0, composed.story()
        yield composed


def set_up(composed: Composed) -> None:
    """Copy what is deployed and run its script."""
    shutil.copytree(ROOT / "deploy", composed.site / "deploy")
    shutil.copy(ROOT / "docker-compose.yml", composed.site)
    names = [FIRST_NAME, composed.address("proxy"), composed.address("mosquitto")]
    subprocess.run([composed.site / "deploy" / "set-up.sh", *names], check=True, capture_output=True)
    composed.said = read_compose(composed.site)
    for name in ("state", "archive", "broker/config", "broker/data", "redis"):
        (composed.folder / name).mkdir(parents=True, mode=0o700)


def read_compose(site: Path) -> dict[str, Any]:
    """Return the compose file with the values of .env beside it in their places."""
    lines = [line.partition("=") for line in (site / ".env").read_text().splitlines() if not line.startswith("#")]
    values = {name: value.strip('"') for name, _, value in lines}

    def fill(match: re.Match[str]) -> str:
        name, kind, word = match[1], match[2], match[3]
        assert values.get(name) or kind == ":-", f"{name}: {word}"
        return values.get(name) or word

    def walk(node: Any) -> Any:
        if isinstance(node, dict):
            return {name: walk(value) for name, value in node.items()}
        if isinstance(node, list):
            return [walk(value) for value in node]
        if isinstance(node, str):
            return re.sub(r"(?<!\$)\$\{(\w+)(:[-?])([^}]*)\}", fill, node).replace("$$", "$")
        return node

    found: dict[str, Any] = walk(yaml.safe_load((site / "docker-compose.yml").read_text()))
    return found


def write_configurations(composed: Composed) -> None:
    """Write Mosquitto's and nginx's own files with this machine's paths and addresses."""
    broker = (ROOT / "deploy" / "mosquitto" / "mosquitto.conf").read_text()
    broker = re.sub(r"^listener (\d+)$", rf"listener \1 {composed.address('mosquitto')}", broker, flags=re.MULTILINE)
    broker = broker.replace("/usr/lib/mosquitto_dynamic_security.so", find_plugin())
    broker = "\n".join(
        line if "plugin /usr" in line else composed.place("mosquitto", line) for line in broker.split("\n")
    )
    proxy = (ROOT / "deploy" / "proxy" / "nginx.conf").read_text()
    proxy = re.sub(r"listen (\d+)", rf"listen {composed.address('proxy')}:\1", proxy)
    proxy = "\n".join(composed.place("proxy", line) for line in proxy.split("\n"))
    as_root = os.geteuid() == 0
    (composed.folder / "mosquitto.conf").write_text(broker + ("\nuser root\n" if as_root else ""))
    (composed.folder / "nginx.conf").write_text(("user root;\n" if as_root else "") + proxy)


def protect_database(composed: Composed) -> None:
    """Give PostgreSQL the deployment's password, and let nobody in without it."""
    word = (composed.site / "secrets" / "database-password").read_text().strip()
    with psycopg.connect(composed.postgres.url, autocommit=True) as connection:
        connection.execute(sql.SQL("ALTER ROLE vipo PASSWORD {}").format(sql.Literal(word)))
        rules = composed.postgres.data / "db" / "pg_hba.conf"
        rules.write_text("host all all 127.0.0.1/32 scram-sha-256\n")
        connection.execute("SELECT pg_reload_conf()")


def wait_open(composed: Composed, ask: Any) -> None:
    """Wait until both web processes answer through the proxy."""

    def ended() -> str:
        once = {name for name, service in composed.said["services"].items() if service.get("restart") == "no"}
        gone = [n for n, p in composed.processes.items() if n not in once and p.poll() is not None]
        return f"{gone} ended by themselves" if gone else ""

    wait_for("the site's answer", ask, 240, every_s=0.3, story=composed.story, hopeless=ended)
