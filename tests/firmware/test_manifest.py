"""The manifest for `mip`: what the real MicroPython installs with it is the whole firmware, and it starts."""

from __future__ import annotations

import json
import re
import subprocess
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

from tests.firmware.rig import FIRMWARE


class Host(SimpleHTTPRequestHandler):
    """Serves the files, and the manifest with full addresses, which MicroPython before 1.26 needs."""

    def do_GET(self) -> None:
        if self.path != "/package.json":
            super().do_GET()
            return
        manifest = json.loads((FIRMWARE / "package.json").read_text())
        assert isinstance(self.server, ThreadingHTTPServer)
        manifest["urls"] = [
            [name, f"http://127.0.0.1:{self.server.server_port}/{path}"] for name, path in manifest["urls"]
        ]
        body = json.dumps(manifest).encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: object) -> None:
        pass


def sources() -> dict[str, str]:
    library = FIRMWARE / "lib"
    return {path.relative_to(library).as_posix(): path.read_text() for path in library.rglob("*.py")}


def test_the_manifest_lists_every_file_and_no_other() -> None:
    manifest = json.loads((FIRMWARE / "package.json").read_text())
    assert [list(pair) for pair in manifest["urls"]] == [[name, f"lib/{name}"] for name in sorted(sources())]
    assert manifest["deps"] == []


def test_mip_installs_the_firmware(micropython: str, tmp_path: Path) -> None:
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Host, directory=str(FIRMWARE))) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        address = f"http://127.0.0.1:{server.server_address[1]}/package.json"
        program = f"import mip; mip.install({address!r}, target={str(tmp_path / 'lib')!r})"
        done = subprocess.run([micropython, "-c", program], capture_output=True, text=True, timeout=60)
        server.shutdown()
    assert done.returncode == 0, done.stdout + done.stderr
    installed = tmp_path / "lib"
    assert {p.relative_to(installed).as_posix(): p.read_text() for p in installed.rglob("*.py")} == sources()
    check = "import vipo.start, vipo.drivers; print(len(vipo.drivers.NAMES))"
    env = {"MICROPYPATH": f"{installed}:.frozen", "PATH": "/usr/bin:/bin"}
    ran = subprocess.run([micropython, "-c", check], env=env, capture_output=True, text=True, timeout=60)
    assert ran.stdout == "7\n", ran.stderr


@pytest.mark.parametrize("name", sorted(sources()))
def test_every_file_is_small_enough_to_be_compiled_on_the_board(micropython: str, tmp_path: Path, name: str) -> None:
    path = tmp_path / "file.py"
    path.write_text(sources()[name])
    program = f"compile(open({str(path)!r}).read(), 'file', 'exec')"
    done = subprocess.run(
        [micropython, "-X", "heapsize=64k", "-c", program], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr


def test_the_guides_configuration_can_be_used_and_its_table_has_every_machine(micropython: str, tmp_path: Path) -> None:
    guide = (FIRMWARE.parent / "docs" / "devices" / "esp32.md").read_text()
    (example,) = re.findall(r"```json\n(.*?)```", guide, re.DOTALL)
    (tmp_path / "config.json").write_text(example.replace("…", "a word or so"))
    program = (
        "from vipo.drivers import NAMES; from vipo.configuration import read_configuration\n"
        f"read_configuration({str(tmp_path / 'config.json')!r}); print(' '.join(NAMES))"
    )
    env = {"MICROPYPATH": f"{FIRMWARE / 'lib'}:.frozen", "PATH": "/usr/bin:/bin"}
    done = subprocess.run([micropython, "-c", program], env=env, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    table = guide.partition("## The machines")[2].partition("\n\n")[0]
    _heading, *machines = re.findall(r"^\| `([a-z-]+)` \|", table, re.MULTILINE)
    assert sorted(machines) == done.stdout.split()
