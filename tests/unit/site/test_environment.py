"""What about the settings stops a start, and that the setting is named."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Protocol

import pytest

from tests.kit.files import ROOT
from vipo_site.environment import is_local

SERVED = {
    "VIPO_MODE": "served",
    "VIPO_SECRET_KEY": "0123456789abcdef0123456789abcdef",
    "VIPO_HOSTS": "vipo.example",
    "VIPO_PROXIES": "10.0.0.2",
    "VIPO_DATABASE_URL": "postgresql://vipo@database/vipo",
    "VIPO_DATABASE_PASSWORD": "word of/the:database",
    "VIPO_REDIS_URL": "redis://redis:6379/0",
    "VIPO_REDIS_PASSWORD": "word@of the redis",
    "VIPO_MQTT_HOST": "broker",
    "VIPO_MQTT_PASSWORD": "word of the broker",
}
SHOW = """
from vipo_site import settings
print(settings.DATABASES["default"].get("PASSWORD"), settings.VIPO_REDIS_URL, settings.VIPO_MQTT["password"], sep="|")
print(settings.SESSION_COOKIE_SECURE, settings.CSRF_COOKIE_SECURE, settings.SECURE_HSTS_SECONDS, settings.VIPO_PROXIES)
print(settings.SECRET_KEY, settings.ALLOWED_HOSTS, settings.VIPO_DEMO, settings.VIPO_DEMO_SIGN_IN)
"""


STARTER = """
import json, os, sys, tempfile, traceback
import celery.app, celery.signals, django.core.exceptions
for line in sys.stdin:
    told = json.loads(line)
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = os.fork()
        if child == 0:
            os.dup2(out.fileno(), 1)
            os.dup2(err.fileno(), 2)
            os.environ.clear()
            os.environ.update(told["environment"])
            os.chdir(told["folder"])
            try:
                exec(told["code"], {})
            except BaseException:
                traceback.print_exc()
            sys.stdout.flush()
            os._exit(0)
        os.waitpid(child, 0)
        said = []
        for file in (out, err):
            file.seek(0)
            said.append(file.read().decode())
    print(json.dumps(said), flush=True)
"""
"""A process that has Celery and Django but nothing of ours, of which each start is a copy: half a second less each."""


@pytest.fixture(scope="module")
def starter() -> Iterator[subprocess.Popen[str]]:
    own = {name: value for name, value in os.environ.items() if not name.startswith(("VIPO_", "DJANGO_"))}
    command = [sys.executable, "-c", STARTER]
    with subprocess.Popen(
        command, env={**own, "PYTHONPATH": str(ROOT)}, cwd="/", stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        yield process


class ReadSettings(Protocol):
    """Returns what a process shows of its settings, and what it says instead of starting."""

    def __call__(self, changes: dict[str, str | None]) -> tuple[str, str]: ...


@pytest.fixture
def read_settings(starter: subprocess.Popen[str], tmp_path: Path) -> ReadSettings:
    def read(changes: dict[str, str | None]) -> tuple[str, str]:
        own = {name: value for name, value in os.environ.items() if not name.startswith(("VIPO_", "DJANGO_"))}
        wanted = {**own, "VIPO_STATE_DIR": str(tmp_path), "PYTHONPATH": str(ROOT), **changes}
        environment = {name: value for name, value in wanted.items() if value is not None}
        told = {"environment": environment, "folder": str(tmp_path), "code": SHOW}
        assert starter.stdin is not None
        assert starter.stdout is not None
        starter.stdin.write(f"{json.dumps(told)}\n")
        starter.stdin.flush()
        shown, complaint = json.loads(starter.stdout.readline())
        said = complaint.strip().rpartition("\n")[2]
        return shown, said.removeprefix("django.core.exceptions.ImproperlyConfigured: ")

    return read


def test_a_served_site_starts_with_safe_settings(read_settings: ReadSettings) -> None:
    shown, _ = read_settings(SERVED)
    assert shown.splitlines() == [
        "word of/the:database|redis://:word%40of%20the%20redis@redis:6379/0|word of the broker",
        "True True 31536000 (IPv4Network('10.0.0.2/32'),)",
        "0123456789abcdef0123456789abcdef ['vipo.example'] False False",
    ]


@pytest.mark.parametrize("name", [name for name in SERVED if name != "VIPO_MODE"])
def test_a_setting_that_is_missing_is_named(read_settings: ReadSettings, name: str) -> None:
    shown, said = read_settings({**SERVED, name: None})
    assert (shown, said.startswith(f"{name} is not set")) == ("", True), said


UNSAFE = {
    "VIPO_MODE": ["server"],
    "VIPO_SECRET_KEY": ["short", "a" * 40],
    "VIPO_MQTT_PASSWORD": ["secret", "aaaaaaaaaaaaaaaaaaa"],
    "VIPO_HOSTS": ["*", ".vipo.example", "vipo.example,*"],
    "VIPO_HTTPS": ["0", "yes"],
    "VIPO_PROXIES": ["0.0.0.0/0", "::/0", "128.0.0.0/1", "proxy", "10.0.0.1/8"],
    "VIPO_DEMO": ["1"],
    "VIPO_MQTT_TLS": ["0"],
    "VIPO_PROCESS": ["webb"],
    "VIPO_REHEARSALS_AT_ONCE": ["0", "-1", "two", "1.5"],
    "VIPO_REHEARSALS_OF_PERSON": ["0"],
    "VIPO_REHEARSALS_OF_SITE": ["0"],
    "VIPO_REHEARSAL_LIMIT_S": ["0", "ten"],
    "VIPO_REHEARSAL_MEMORY_MB": ["511"],
    "VIPO_AUDIT_DAYS": ["29", "ever"],
    "VIPO_MAIL_TLS": ["ssl"],
    "VIPO_SECOND_FACTOR": ["viewer", "all"],
    "VIPO_SIGN_ON": ["Acme", "acme,acme", "a b", "-a"],
    "VIPO_MAIL_PORT": ["0", "smtp"],
}


@pytest.mark.parametrize(("name", "value"), [(name, value) for name, values in UNSAFE.items() for value in values])
def test_an_unsafe_setting_stops_the_start_and_is_named(read_settings: ReadSettings, name: str, value: str) -> None:
    shown, said = read_settings({**SERVED, name: value})
    assert (shown, said.startswith(name)) == ("", True), said


def test_a_way_to_send_mail_is_safe_and_says_from_whom(read_settings: ReadSettings) -> None:
    way = {**SERVED, "VIPO_MAIL_HOST": "mail.example"}
    shown, said = read_settings(way)
    assert (shown, said.startswith("VIPO_MAIL_FROM is not set")) == ("", True), said
    shown, said = read_settings({**way, "VIPO_MAIL_FROM": "vipo@mail.example", "VIPO_MAIL_TLS": "none"})
    assert (shown, said.startswith("VIPO_MAIL_TLS is none and VIPO_MAIL_HOST another machine")) == ("", True), said
    local = {"VIPO_MAIL_HOST": "localhost", "VIPO_MAIL_FROM": "vipo@mail.example", "VIPO_MAIL_TLS": "none"}
    assert read_settings({**SERVED, **local})[0] != ""


ACME = {
    "VIPO_SIGN_ON": "acme-2",
    "VIPO_SIGN_ON_ACME_2_ISSUER": "https://acme.example/realm",
    "VIPO_SIGN_ON_ACME_2_CLIENT_ID": "vipo",
    "VIPO_SIGN_ON_ACME_2_CLIENT_SECRET": "a secret of acme",
}
OFF = [
    *((name, None, f"{name} is not set") for name in ACME if name != "VIPO_SIGN_ON"),
    ("VIPO_SIGN_ON_ACME_2_ISSUER", "http://acme.example", "VIPO_SIGN_ON_ACME_2_ISSUER is unsafe"),
    ("VIPO_SIGN_ON_ACME_2_ISSUER", "https://acme.example/?a=b", "VIPO_SIGN_ON_ACME_2_ISSUER is no issuer"),
    ("VIPO_SIGN_ON_ACME_2_LINK", "yes", "VIPO_SIGN_ON_ACME_2_LINK is 'yes'"),
    ("VIPO_SIGN_ON_ACME_2_DOMAINS", "acme.example,*", "VIPO_SIGN_ON_ACME_2_DOMAINS has '*'"),
]


@pytest.mark.parametrize(("name", "value", "expected"), OFF)
def test_a_provider_whose_settings_are_missing_or_unsafe_stops_the_start(
    read_settings: ReadSettings, name: str, value: str | None, expected: str
) -> None:
    shown, said = read_settings({**SERVED, **ACME, name: value})
    assert (shown, said.startswith(expected)) == ("", True), said
    assert "a secret of acme" not in said


def test_a_provider_is_set_up_and_its_secret_read_from_a_file_by_who_signs_alone(
    tmp_path: Path, read_settings: ReadSettings
) -> None:
    assert read_settings({**SERVED, **ACME})[0] != ""
    (tmp_path / "secret").write_text("a secret of acme\n")
    name = "VIPO_SIGN_ON_ACME_2_CLIENT_SECRET"
    assert read_settings({**SERVED, **ACME, name: None, f"{name}_FILE": str(tmp_path / "secret")})[0] != ""
    assert read_settings({**SERVED, **ACME, name: None, "VIPO_PROCESS": "worker"})[0] != ""


def test_secrets_are_read_from_files(tmp_path: Path, read_settings: ReadSettings) -> None:
    changes: dict[str, str | None] = dict(SERVED)
    for name in ("VIPO_SECRET_KEY", "VIPO_DATABASE_PASSWORD", "VIPO_REDIS_PASSWORD", "VIPO_MQTT_PASSWORD"):
        (tmp_path / name).write_text(f"{SERVED[name]}\n")
        changes |= {name: None, f"{name}_FILE": str(tmp_path / name)}
    assert read_settings(changes)[0] == read_settings(dict(SERVED))[0]
    both = read_settings({**changes, "VIPO_SECRET_KEY": "x"})[1]
    assert both == "VIPO_SECRET_KEY and VIPO_SECRET_KEY_FILE are both set; keep the file and take the other away."
    (tmp_path / "VIPO_MQTT_PASSWORD").unlink()
    gone = read_settings(changes)[1]
    assert gone.startswith("VIPO_MQTT_PASSWORD_FILE names ")
    assert gone.endswith("which cannot be read: No such file or directory.")


def test_former_keys_stand_in_further_lines_and_sign_nothing(tmp_path: Path, read_settings: ReadSettings) -> None:
    (tmp_path / "keys").write_text(f"{SERVED['VIPO_SECRET_KEY']}\n{'a former key of it, of the same length' * 2}\n\n")
    named = {**SERVED, "VIPO_SECRET_KEY": None, "VIPO_SECRET_KEY_FILE": str(tmp_path / "keys")}
    assert read_settings(named) == read_settings(dict(SERVED))
    (tmp_path / "keys").write_text(f"{SERVED['VIPO_SECRET_KEY']}\nshort\n")
    assert read_settings(named)[1] == "VIPO_SECRET_KEY can be guessed: take 32 random characters at least."
    blank = read_settings({**SERVED, "VIPO_SECRET_KEY": "  "})
    assert blank == ("", "VIPO_SECRET_KEY can be guessed: take 32 random characters at least.")


@pytest.mark.parametrize(
    ("process", "needs_none_of"),
    [
        ("gateway", ["VIPO_SECRET_KEY"]),
        ("worker", ["VIPO_SECRET_KEY", "VIPO_MQTT_PASSWORD"]),
        ("ticker", ["VIPO_SECRET_KEY", "VIPO_MQTT_PASSWORD"]),
        ("twin", ["VIPO_SECRET_KEY", "VIPO_MQTT_PASSWORD"]),
    ],
)
def test_a_process_starts_without_the_secrets_that_it_does_not_use(
    read_settings: ReadSettings, process: str, needs_none_of: list[str]
) -> None:
    changes = {**SERVED, "VIPO_PROCESS": process, **dict.fromkeys(needs_none_of)}
    shown, said = read_settings(changes)
    assert (len(shown.splitlines()), said) == (3, "")
    assert SERVED["VIPO_SECRET_KEY"] not in shown


def test_this_machine_alone_may_do_without_https_and_have_a_demo(read_settings: ReadSettings) -> None:
    local = {**SERVED, "VIPO_HOSTS": "localhost,127.0.0.1,[::1]", "VIPO_HTTPS": "0", "VIPO_DEMO": "1"}
    shown, _ = read_settings({**local, "VIPO_PROXIES": None})
    assert shown.splitlines()[1:] == [
        "False False 0 ()",
        f"{SERVED['VIPO_SECRET_KEY']} ['localhost', '127.0.0.1', '[::1]'] True False",
    ]


def test_the_embedded_mode_offers_its_demo_on_this_machine_alone(read_settings: ReadSettings) -> None:
    shown, _ = read_settings({"VIPO_DEMO": "1"})
    assert shown.splitlines()[2].endswith(" ['127.0.0.1', 'localhost', '[::1]'] True True")
    shown, said = read_settings({"VIPO_DEMO": "1", "VIPO_HOSTS": "localhost,vipo.example"})
    assert (shown, said.startswith("VIPO_DEMO=1 makes accounts whose passwords are shown")) == ("", True)


@pytest.mark.parametrize(
    ("host", "local"),
    [
        *((host, True) for host in ("localhost", "LOCALHOST:8000", "127.0.0.1", "127.9.9.9:80", "[::1]", "::1")),
        *((host, False) for host in ("localhost.example", "10.0.0.1", "0.0.0.0", "[::]", "vipo.example", "", "*")),
    ],
)
def test_which_hosts_are_this_machine(host: str, local: bool) -> None:
    assert is_local(host) is local


TOUCH = """
import django, json, pathlib, sys
django.setup()
django.db.connection.cursor().execute("CREATE TABLE x (y)")
print(json.dumps({path.name: oct(path.stat().st_mode)[-3:] for path in pathlib.Path(sys.argv[1]).iterdir()}))
"""


def test_files_of_this_machine_are_its_owners_alone(tmp_path: Path) -> None:
    state = tmp_path / "state"
    state.mkdir(mode=0o755)
    (state / "vipo.sqlite3").touch(mode=0o644)
    own = {"VIPO_STATE_DIR": str(state), "DJANGO_SETTINGS_MODULE": "vipo_site.settings", "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", TOUCH, str(state)]
    done = subprocess.run(command, env={**os.environ, **own}, capture_output=True, text=True, umask=0o022)
    database = dict.fromkeys(("vipo.sqlite3", "vipo.sqlite3-shm", "vipo.sqlite3-wal"), "600")
    assert json.loads(done.stdout) == {**database, "secrets": "700"}, done.stderr
    assert oct(state.stat().st_mode)[-3:] == "700"


def test_a_file_of_kinds_that_cannot_be_read_stops_the_start(tmp_path: Path) -> None:
    own = {name: value for name, value in os.environ.items() if not name.startswith(("VIPO_", "DJANGO_"))}
    told = {**own, "VIPO_STATE_DIR": str(tmp_path), "VIPO_KINDS": str(tmp_path / "kinds.toml")}
    command = [sys.executable, "manage.py", "check"]
    started = subprocess.run(command, cwd=ROOT, env=told, capture_output=True, text=True, timeout=60, check=False)
    assert started.returncode != 0
    assert f"VIPO_KINDS names {tmp_path / 'kinds.toml'}, which cannot be read" in started.stderr
