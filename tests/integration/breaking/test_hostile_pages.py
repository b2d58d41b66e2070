"""Bad input over HTTP and sockets: each gets a sentence, and the server goes on."""

from __future__ import annotations

import asyncio
import os
import socket
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest
import websockets

from tests.integration.breaking.site import Factory
from tests.kit.files import ROOT
from tests.kit.programs import document, step
from tests.kit.servers import free_port

YAML = b"image: m.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
BROKEN_MAPS = {
    "not yaml": (b"\x00\xff{{{", b"P5 2 2 255\n\0\0\0\0"),
    "no resolution": (b"image: m.pgm\norigin: [0, 0, 0]\n", b"P5 2 2 255\n\0\0\0\0"),
    "not an image": (YAML, b"<html>"),
    "image cut off": (YAML, b"P5 4000 4000 255\n\0\0"),
    "resolution is not a number": (YAML.replace(b"0.05", b".nan"), b"P5 2 2 255\n\0\0\0\0"),
    "an alias bomb": (b"a: &a [x, x]\nb: &b [*a, *a]\nimage: [*b, *b]\nresolution: 1\n", b"P5 2 2 255\n\0\0\0\0"),
    "empty": (b"", b""),
}


def test_wrong_passwords_get_a_sentence_and_then_a_pause(factory: Factory) -> None:
    stranger = factory.stranger()
    words = {"email": "nobody@vipo.example", "password": "wrong"}
    answers = [stranger.post("/api/sign-in", json=words) for _ in range(9)]
    assert [a.status_code for a in answers] == [401] * 8 + [429]
    assert answers[0].json()["detail"] == "The e-mail address or the password is wrong. Check both and try again."
    assert answers[8].json()["detail"] == "Too many sign-ins failed. Try again in 15 min."


@pytest.mark.parametrize("name", BROKEN_MAPS)
def test_a_broken_map_is_refused_with_a_sentence(factory: Factory, name: str) -> None:
    yaml, image = BROKEN_MAPS[name]
    files = {"yaml": ("m.yaml", yaml), "image": ("m.pgm", image)}
    answer = factory.admin.post("/api/sites", data={"name": f"Broken {name}"}, files=files)
    assert answer.status_code == 422, answer.text
    assert answer.json()["detail"].endswith(".")
    assert len(answer.json()["detail"]) > 20
    assert [s["slug"] for s in factory.admin.get("/api/sites").json()] == ["painting-factory"]


def test_empty_and_nonsense_programs_are_not_run(factory: Factory) -> None:
    nonsense = {
        "a": {"kind": "frobnicate", "place": ["b", "body", "1"], "pos": "here", "params": {"x": [[[]]]}},
        "b": {"kind": "while", "place": ["b", "body", "zz"], "pos": None, "params": {"condition": {"op": "system"}}},
        "c": step("move", to={"device": "no such"}, role="nobody"),
        "d": {"kind": 7, "place": 7, "pos": 7, "params": {}},
    }
    programs = factory.plant(
        {"Empty": document({}), "Nonsense": document(nonsense, roles={"r": 3}, functions={"f": []})}
    )
    for program in programs.values():
        answer = factory.admin.post(f"/api/programs/{program}/runs", json={})
        assert answer.status_code == 422, answer.text
        assert answer.json()["code"] == "not_ready"
        assert answer.json()["detail"].startswith("The program has "), answer.text


def test_changes_without_the_token_are_refused(factory: Factory) -> None:
    client = factory.signed_in("author")
    del client.headers["X-CSRFToken"]
    answer = client.post("/api/sites/painting-factory/programs", json={"name": "Forged"})
    assert answer.status_code == 403
    assert answer.json()["code"] == "not_allowed"


async def close_code(url: str, origin: str, cookie: str = "") -> int:
    headers = {"Cookie": cookie} if cookie else {}
    async with websockets.connect(url, origin=websockets.Origin(origin), additional_headers=headers) as connection:
        await asyncio.wait_for(connection.wait_closed(), 10)
        assert connection.close_code is not None
        return connection.close_code


async def test_sockets_refuse_unknown_addresses_strangers_and_foreign_pages(factory: Factory) -> None:
    base = factory.demo.url.replace("http", "ws")
    cookie = "; ".join(f"{c.name}={c.value}" for c in factory.admin.cookies.jar)
    assert await close_code(f"{base}/ws/nothing/here", factory.demo.url, cookie) == 4404
    assert await close_code(f"{base}/ws/program/nonsense", factory.demo.url, cookie) == 4404
    assert await close_code(f"{base}/ws/site/painting-factory", factory.demo.url) == 4401
    with pytest.raises(websockets.InvalidStatus) as refusal:
        await close_code(f"{base}/ws/site/painting-factory", "http://evil.example", cookie)
    assert refusal.value.response.status_code == 403


def start_demo(state: Path, **more: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "VIPO_STATE_DIR": str(state), "VIPO_MQTT_PORT": str(free_port()), **more}
    environment.pop("DJANGO_SETTINGS_MODULE", None)
    return subprocess.run(
        [sys.executable, "-m", "vipo_site.demo"],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
    )


def test_a_port_in_use_is_said_before_anything_is_touched(tmp_path: Path) -> None:
    with closing(socket.create_server(("127.0.0.1", 0))) as taken:
        port = str(taken.getsockname()[1])
        ended = start_demo(tmp_path / "state", PORT=port, RESET="1")
        assert ended.returncode == 1
        assert ended.stderr.startswith(f"Port {port} of this machine is in use. Stop what uses it")
        assert "make demo PORT=" in ended.stderr
        assert not (tmp_path / "state").exists()
        other = start_demo(tmp_path / "state", PORT=str(free_port()), VIPO_MQTT_PORT=port)
    assert other.returncode == 1
    assert other.stderr.startswith(f"The MQTT port {port} is in use by another program.")
    assert "Traceback" not in other.stderr


def test_a_port_that_is_none_is_a_usage_error(tmp_path: Path) -> None:
    ended = start_demo(tmp_path / "state", PORT="eighty")
    assert ended.returncode == 2
    assert "argument --port: invalid int value: 'eighty'" in ended.stderr
    assert "Traceback" not in ended.stderr


def test_the_served_mode_names_the_setting_that_is_missing() -> None:
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("VIPO_", "DJANGO_"))} | {
        "VIPO_MODE": "served"
    }
    ended = subprocess.run(
        [sys.executable, "manage.py", "gateway"], cwd=ROOT, env=environment, capture_output=True, text=True
    )
    assert ended.returncode == 1
    assert ended.stderr == "VIPO_SECRET_KEY is not set; the served mode needs it (see docs/operations.md).\n"
