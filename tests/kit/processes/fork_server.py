"""The process that has loaded the product and forks: -m tests.kit.processes.fork_server SOCKET

Each message of the socket asks for a process: what to run, with which environment, in which folder, and with it come
its input, output and errors and a pipe into which its exit code is written. It is answered with the process's id. When
the socket closes, this process ends; those that it forked go on.
"""

from __future__ import annotations

import functools
import gc
import importlib
import json
import os
import runpy
import select
import signal
import socket
import sys
import tempfile
import threading
from dataclasses import dataclass, field
from typing import Any

MODULES = (
    *("celery.bin.worker", "daphne.http_protocol", "daphne.ws_protocol", "servestatic", "django.core.management"),
    *("vipo_site.http.api", "vipo_site.http.middleware", "vipo_site.http.entrance", "vipo_site.http.sessions"),
    *("vipo_site.http.actor_middleware", "vipo_site.http.observation", "vipo_site.http.shutdown", "vipo_site.urls"),
    *("editor.rooms.socket", "execution.services", "execution.wall.socket", "registry.api.site_socket"),
    *("django.db.backends.sqlite3.base", "django.db.backends.postgresql.base", "django.contrib.sessions.backends.db"),
    *("channels.auth", "channels.routing", "channels.layers"),
)
"""What web processes load, but for what, when loaded, reads settings, opens something or chooses a loop of events."""

MOST_BYTES = 2**20
SETTINGS = ("vipo_site.settings", "tests.settings")
OURS = ("vipo_device", "registry", "editor", "simulation", "connectors", "execution", "vipo_site")
CACHES: list[Any] = []


@dataclass
class Asked:
    """What shall run."""

    arguments: list[str]
    cwd: str
    environment: dict[str, str]
    new_session: bool
    files: list[int] = field(default_factory=list)


def load() -> None:
    """Load what most processes of the product load."""
    os.environ["DJANGO_SETTINGS_MODULE"] = SETTINGS[0]
    import django

    django.setup()
    for name in MODULES:
        importlib.import_module(name)
    assert "twisted.internet.reactor" not in sys.modules, "a loop of events must not be shared"
    assert threading.active_count() == 1, "threads do not come along when a process is forked"
    gc.collect()
    CACHES.extend(
        each for each in gc.get_objects() if isinstance(each, functools._lru_cache_wrapper) and _may_read(each)
    )
    gc.freeze()


def _may_read(cache: Any) -> bool:
    """Tell whether what a cache keeps can come from settings."""
    return str(cache.__module__).partition(".")[0] in {*OURS, "django"}


def serve(requests: socket.socket) -> Asked | None:
    """Fork whatever is asked for; return None at the end, and what to run in a forked process."""
    waiting: dict[int, tuple[int, int]] = {}
    while True:
        ready, _, _ = select.select([requests.fileno(), *waiting], [], [])
        for ended in waiting.keys() & set(ready):
            _tell_end(ended, *waiting.pop(ended))
        if requests.fileno() not in ready:
            continue
        message, files, _, _ = socket.recv_fds(requests, MOST_BYTES, 4)
        if not message:
            return None
        asked = Asked(**json.loads(message), files=files[:3])
        pid = os.fork()
        if pid == 0:
            for not_its in (requests.fileno(), files[3], *waiting, *(told for _, told in waiting.values())):
                os.close(not_its)
            return asked
        for file in asked.files:
            os.close(file)
        waiting[os.pidfd_open(pid)] = pid, files[3]
        requests.send(str(pid).encode())


def _tell_end(ended: int, pid: int, told: int) -> None:
    """Write the exit code of a process that has ended to whoever asked for it, if they are still there."""
    os.close(ended)
    _, status = os.waitpid(pid, 0)
    try:
        os.write(told, str(os.waitstatus_to_exitcode(status)).encode())
    except BrokenPipeError:
        pass
    finally:
        os.close(told)


def become(asked: Asked) -> None:
    """Be the process that was asked for: its files, folder and environment, and nothing that was read from another."""
    if asked.new_session:
        os.setsid()
    for standard, file in enumerate(asked.files[:3]):
        os.dup2(file, standard)
        os.close(file)
    sys.stdin, sys.stdout = open(0, encoding="utf-8"), open(1, "w", encoding="utf-8")  # noqa: SIM115
    sys.stderr = open(2, "w", encoding="utf-8", buffering=1, errors="backslashreplace")  # noqa: SIM115
    os.chdir(asked.cwd)
    os.environ.clear()
    os.environ.update(asked.environment)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    _forget_settings()


def _forget_settings() -> None:
    """Let settings be read from this process's environment, and all that is made of them be made anew."""
    from channels.layers import channel_layers
    from django.conf import settings
    from django.core.cache import caches
    from django.db import connections
    from django.utils.functional import empty

    handlers: tuple[Any, ...] = (connections, caches)
    for handler in handlers:
        for name in list(handler.settings):
            if hasattr(handler._connections, name):
                assert getattr(handler[name], "connection", None) is None, "a connection must not be shared"
                del handler[name]
        del handler.__dict__["settings"]
        handler._settings = None
    assert not channel_layers.backends
    for name in SETTINGS:
        sys.modules.pop(name, None)
    settings._wrapped = empty
    for each in CACHES:
        each.cache_clear()


def run(arguments: list[str]) -> None:
    """Run what Python runs when these arguments follow its name."""
    first, *rest = arguments
    if first == "-m":
        sys.argv = rest
        runpy.run_module(rest[0], run_name="__main__", alter_sys=True)
    elif first == "-c":
        sys.argv = ["-c", *rest[1:]]
        scope: dict[str, Any] = {"__name__": "__main__"}
        exec(compile(rest[0], "<string>", "exec"), scope)
    else:
        sys.argv = arguments
        runpy.run_path(first, run_name="__main__")


def main() -> None:
    """Load, fork, and run what was asked for in each process that was forked."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with tempfile.TemporaryDirectory() as state:
        os.environ["VIPO_STATE_DIR"] = state
        load()
    asked = serve(socket.socket(fileno=int(sys.argv[1])))
    if asked is not None:
        become(asked)
        run(asked.arguments)


if __name__ == "__main__":
    main()
