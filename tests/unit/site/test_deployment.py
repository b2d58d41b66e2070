"""What an operator may set: settings, docker-compose.yml, deploy/env.example and docs/operations.md name the same."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest
import yaml
from django.core.management import get_commands

from editor.rooms.yjs_protocol import MOST_FRAME_BYTES
from tests.kit.files import ROOT
from vipo_site.http import MOST_MESSAGE_BYTES

COMPOSE = (ROOT / "docker-compose.yml").read_text()
EXAMPLE = (ROOT / "deploy" / "env.example").read_text()
SAID: dict[str, Any] = yaml.safe_load(COMPOSE)
SERVICES: dict[str, dict[str, Any]] = SAID["services"]
USED = re.compile(r"(?<!\$)\$\{(\w+)(?::-([^}]*))?")
NAMED = re.compile(r"^(#?)(\w+)=(.*)$", re.MULTILINE)
FOR_SET_UP = {"VIPO_NAMES"}
"""What deploy/set-up.sh alone reads."""
FOR_OTHER_FORMS = {
    "VIPO_DATABASE",
    "VIPO_REDIS",  # both are the beginnings of names
    "VIPO_DATABASE_IDLE_S",
    "VIPO_DATABASE_LOCK_S",
    "VIPO_DATABASE_STATEMENT_S",
    "VIPO_DEFAULT_SITE",
    "VIPO_FRONTEND_DIST",
    "VIPO_GATEWAY",
    "VIPO_SPEED",
}
"""What a site of docker-compose.yml has no reason to set."""
FOR_TESTS = {"VIPO_DATABASE", "VIPO_REDIS", "VIPO_FRONTEND_DIST", "VIPO_FAULTS"}
"""Beginnings of names, and what only tests set."""
KEEPS_FILES = {
    "connectors/management/commands/mtconnect.py": {"mtconnect"},
    "connectors/management/commands/vda5050.py": {"vda5050"},
    "execution/stand_ins/stand_ins.py": {"stand-ins"},
    "registry/api/people.py": set(),  # reads the demo's accounts, where the embedded mode offers them
    "registry/management/commands/end_demo.py": {"setup"},
    "registry/management/commands/seed_demo.py": {"setup"},
    "simulation/management/commands/scout.py": set(),  # no service
    "simulation/management/commands/twin.py": {"twin"},
    "vipo_site/cli/repair.py": {"setup"},  # as docs/cli.md has it run
    "vipo_site/demo/main.py": set(),  # the embedded mode
}
"""Which modules use files of VIPO_STATE_DIR, and as which services they run."""


def read_by_settings() -> set[str]:
    source = (ROOT / "vipo_site" / "settings.py").read_text() + (ROOT / "vipo_site" / "environment.py").read_text()
    return set(re.findall(r'"(VIPO_[A-Z0-9_]+)"', source))


def test_the_web_processes_take_messages_of_sockets_as_large_as_everywhere() -> None:
    given = "--websocket-max-{}-size {}"
    wanted = " ".join(given.format(what, MOST_MESSAGE_BYTES) for what in ("message", "frame"))
    (image,) = re.findall(r"^CMD (.*)$", (ROOT / "Dockerfile").read_text(), re.MULTILINE)
    assert wanted in " ".join(json.loads(image))
    assert wanted in (ROOT / "docs" / "operations.md").read_text()
    assert MOST_MESSAGE_BYTES > MOST_FRAME_BYTES


def test_env_example_names_all_that_the_deployment_takes_from_it_and_nothing_else() -> None:
    used = {name for name, _ in USED.findall(COMPOSE)}
    named = {name for _, name, _ in NAMED.findall(EXAMPLE)}
    assert (sorted(used - named), sorted(named - used - FOR_SET_UP)) == ([], [])


def test_what_env_example_shows_as_usual_is_what_holds_without_it() -> None:
    defaults = {name: default for name, default in USED.findall(COMPOSE) if default}
    shown = {name: value for is_comment, name, value in NAMED.findall(EXAMPLE) if value}
    examples = {"VIPO_TIME_ZONE", "VIPO_LOG", "VIPO_DEMO", "VIPO_MTCONNECT_SITE", "VIPO_VDA5050_SITE"}
    both = shown.keys() & defaults.keys() - examples
    assert {name: shown[name] for name in both} == {name: defaults[name] for name in both}
    assert len(both) > 10


def test_each_setting_that_is_read_from_the_environment_stands_in_the_table() -> None:
    """Also those of connectors and of single commands; what only tests set does not."""
    page = (ROOT / "docs" / "operations.md").read_text()
    folders = ("connectors", "editor", "execution", "registry", "simulation", "vipo_device", "vipo_site")
    sources = [path.read_text() for folder in folders for path in (ROOT / folder).rglob("*.py")]
    read = read_by_settings() | {
        name
        for source in sources
        for name in re.findall(r'(?:environ(?:\.get\(|\[)|^[A-Z_]+ = )"(VIPO_\w+)"', source, re.MULTILINE)
    }
    assert sorted(name for name in read - FOR_TESTS if f"`{name}`" not in page) == []


@pytest.mark.parametrize("name", sorted(read_by_settings() - FOR_OTHER_FORMS))
def test_a_setting_is_given_to_the_processes_of_the_deployment(name: str) -> None:
    given = {key for service in SERVICES.values() for key in service.get("environment", {})}
    assert {name, f"{name}_FILE"} & given


def test_whoever_sends_mail_knows_the_mail_server() -> None:
    """The web processes invite people; the worker of upkeep sends all other mail."""
    upkeep = {name for name, service in SERVICES.items() if "upkeep" in " ".join(service.get("command", ()))}
    senders = {name for name, service in SERVICES.items() if "VIPO_MAIL_HOST" in service.get("environment", {})}
    assert senders == {"web-1", "web-2"} | upkeep
    (settings,) = {
        tuple(f"{key}={value}" for key, value in SERVICES[name]["environment"].items() if key.startswith("VIPO_MAIL"))
        for name in senders
    }
    assert len(settings) == 6


@pytest.mark.parametrize("name", sorted(set(re.findall(r"^#?(VIPO_(?:KEEP|REHEARSAL)\w+)=", EXAMPLE, re.M))))
def test_a_limit_that_env_example_shows_is_that_of_the_settings(name: str) -> None:
    """Where the deployment has no other: rehearsals at once are two there, else as many as there are cores."""
    shown = {key: value for _, key, value in NAMED.findall(EXAMPLE)}[name]
    source = (ROOT / "vipo_site" / "settings.py").read_text()
    (default,) = re.findall(rf'whole_number\("{name}", ([^,)]+(?:\(\) or 1)?)', source)
    assert shown == ("2" if name == "VIPO_REHEARSALS_AT_ONCE" else default)


def test_the_absence_that_is_worth_an_alert_is_said_everywhere_as_it_holds() -> None:
    """The table of time limits is held by test_time_limits.py."""
    source, pages = (ROOT / "vipo_site" / "settings.py").read_text(), ROOT / "docs"
    (default,) = re.findall(r'environ\.get\("VIPO_OFFLINE_ALERT_S", "(\d+)"\)', source)
    assert dict(USED.findall(COMPOSE))["VIPO_OFFLINE_ALERT_S"] == default
    assert {name: value for _, name, value in NAMED.findall(EXAMPLE)}["VIPO_OFFLINE_ALERT_S"] == default
    assert f"| `VIPO_OFFLINE_ALERT_S` | `{default}` |" in (pages / "operations.md").read_text()
    assert f"`VIPO_OFFLINE_ALERT_S` ({int(default) // 60} min)" in (pages / "api.md").read_text()


@pytest.mark.parametrize("name", sorted(SERVICES))
def test_a_service_names_only_what_is_there_and_is_closed(name: str) -> None:
    service = SERVICES[name]
    assert set(service.get("depends_on", ())) <= SERVICES.keys()
    assert set(service.get("secrets", ())) <= SAID["secrets"].keys()
    assert set(service["networks"]) <= SAID["networks"].keys()
    volumes = {volume.partition(":")[0] for volume in service.get("volumes", ())}
    assert all((ROOT / path).exists() for path in volumes if path.startswith("./"))
    assert {volume for volume in volumes if not volume.startswith("./")} <= SAID["volumes"].keys()
    assert (service["read_only"], service["cap_drop"], "mem_limit" in service) == (True, ["ALL"], True)
    files = {value for key, value in service.get("environment", {}).items() if key.endswith("_FILE")}
    unknown = {path.removeprefix("/run/secrets/") for path in files} - set(service.get("secrets", ()))
    assert unknown == set()


def test_whoever_keeps_files_has_the_volume_for_them_and_nobody_else() -> None:
    folders = ("connectors", "editor", "execution", "registry", "simulation", "vipo_site")
    modules = {path for folder in folders for path in (ROOT / folder).rglob("*.py") if path.name != "settings.py"}
    using = {path for path in modules if "settings.VIPO_STATE_DIR" in path.read_text()}
    assert {path.relative_to(ROOT).as_posix() for path in using} == KEEPS_FILES.keys()
    mounting = {name for name, service in SERVICES.items() if "state:/state" in service.get("volumes", ())}
    assert mounting == set().union(*KEEPS_FILES.values())


@pytest.mark.parametrize(
    "name", sorted(name for name, each in SERVICES.items() if "manage.py" in each.get("command", ()))
)
def test_a_service_runs_a_command_that_there_is(name: str) -> None:
    command = SERVICES[name]["command"]
    assert command[command.index("manage.py") + 1] in get_commands()


def test_each_service_waits_for_others_that_do_not_wait_for_it() -> None:
    waits = {name: set(each.get("depends_on", ())) for name, each in SERVICES.items()}
    while free := {name for name, others in waits.items() if not others & waits.keys()}:
        waits = {name: others for name, others in waits.items() if name not in free}
    assert waits == {}
