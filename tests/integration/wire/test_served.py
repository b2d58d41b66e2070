"""The run part of the journey in the served form: two web processes, two workers, gateway, ticker and twin."""

from __future__ import annotations

import json
import signal
from collections.abc import Generator, Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.sync.client import connect
from websockets.typing import Origin

from tests.integration.web_of_things.node_wot import (
    check_observer,
    check_story,
    make_token,
    run_client,
    wait_for_mixer,
)
from tests.kit.served import WORKER, Served, running_served
from tests.kit.servers import Redis
from tests.kit.waiting import PATIENCE_S
from vipo_device.protocol.mqtt_client import MqttClient
from vipo_device.protocol.sockets import tls_context

pytestmark = pytest.mark.servers
SITE = "/api/sites/painting-factory"
MAKE_TASK = """
import json, pathlib
from editor import services
document = json.loads(pathlib.Path("examples/pick-and-drop.json").read_text())["document"]
services.create_program(site="painting-factory", name="Task", document=document)
wait = {"kind": "wait", "place": ["program", "body", "V"], "pos": [1, -1], "params": {"seconds": %d}}
document = {**document, "steps": {"wait": wait}}
services.create_program(site="painting-factory", name="Wait", document=document)
repeat = {"kind": "repeat", "place": ["program", "body", "V"], "pos": [1, -1], "params": {"times": 100000}}
again = {"kind": "wait", "place": ["repeat", "body", "V"], "pos": [1, -1], "params": {"seconds": 0.02}}
document = {**document, "steps": {"repeat": repeat, "again": again}}
services.create_program(site="painting-factory", name="Endless", document=document)
"""
WAIT_S, DUE_S = 20, 15
OVER = {"finished", "failed", "cancelled"}


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory, module_database_url: str, shared_redis: Redis) -> Iterator[Served]:
    with running_served(tmp_path_factory.mktemp("served"), module_database_url, shared_redis.url) as running:
        running.manage("shell", "-c", MAKE_TASK % WAIT_S)
        for number in (0, 1):
            running.wait("a web process", lambda n=number: is_up(running.web_ports[n]), 200)
        yield running


def is_up(port: int) -> bool:
    try:
        return httpx.get(f"http://127.0.0.1:{port}/health", timeout=10).status_code == 200
    except httpx.HTTPError:
        return False


def devices(client: httpx.Client) -> dict[str, Any]:
    return {device["id"]: device for device in client.get(f"{SITE}/devices").json()}


def start_task(served: Served, client: httpx.Client) -> str:
    programs = client.get(f"{SITE}/programs").json()
    task = next(program for program in programs if program["name"] == "Task")
    answer = client.post(f"/api/programs/{task['id']}/runs", json={})
    assert answer.status_code == 202, answer.text + served.story()
    return str(answer.json()["id"])


def test_devices_join_over_mosquitto_and_both_web_processes_show_them(served: Served) -> None:
    for web in (0, 1):
        with served.signed_in("author", web) as client:
            served.wait(
                "every device online",
                lambda c=client: sum(d["status"] == "idle" for d in devices(c).values()) == 10,
                120,
            )
            assert devices(client)["paintMixer03"]["status"] == "pending"


def test_the_map_of_a_robot_comes_into_postgresql(served: Served) -> None:
    with served.signed_in("author") as client:
        path = f"{SITE}/devices/robot01/map"
        told = served.wait("the map", lambda: (found := client.get(path)).status_code == 200 and found.json(), 120)
        site = client.get(f"{SITE}/map").json()
        assert (told["width"], told["origin"]) == (site["width"], site["origin"])
        assert len(client.get(f"{path}/cells").content) == told["width"] * told["height"]


def test_messages_that_cannot_be_read_are_noted_and_harm_nobody(served: Served) -> None:
    client = MqttClient(
        host="localhost",
        port=served.mosquitto.port,
        username="server",
        password=served.environment["VIPO_MQTT_PASSWORD"],
        client_id="nonsense",
        tls=tls_context(served.mosquitto.authority),
    )
    client.start()
    assert client.wait_connected(20)
    for kind in ("state", "presence", "ack", "desc"):
        for nonsense in (b"{", b"\xff\xfe", b'{"boot": NaN}', b'{"a": 1, "a": 2}', b"[" * 5000, b"<rdf:RDF/>"):
            client.publish(f"vipo/v1/dev/dropOff01/up/{kind}", nonsense)
    with served.signed_in("admin") as page:
        served.wait(
            "a note in the device's history",
            lambda: any(e["kind"] == "problem" for e in page.get(f"{SITE}/devices/dropOff01/events").json()),
        )
        assert devices(page)["dropOff01"]["status"] == "idle"
    client.stop()
    assert served.processes["gateway"].poll() is None


def heard_of_obstacles(served: Served, client: httpx.Client, web: int) -> Generator[None]:
    """Go on at `hello`, from when on news come, then once for each time that it says that obstacles have changed."""
    address = f"127.0.0.1:{served.web_ports[web]}"
    cookies = "; ".join(f"{name}={value}" for name, value in client.cookies.items())
    with connect(f"ws://{address}/ws/site/painting-factory", origin=Origin(f"http://{address}"),
                 additional_headers={"Cookie": cookies}, max_size=None) as socket:  # fmt: skip
        assert json.loads(socket.recv(timeout=PATIENCE_S))["type"] == "hello"
        yield
        while True:
            served.wait(
                "news of obstacles", lambda: json.loads(socket.recv(timeout=PATIENCE_S)).get("type") == "obstacles"
            )
            yield


def test_obstacles_are_the_same_at_both_web_processes_whoever_moves_them(served: Served) -> None:
    with served.signed_in("author", 0) as first, served.signed_in("admin", 1) as second:
        news = heard_of_obstacles(served, second, 1)
        next(news)
        made = first.post(f"{SITE}/obstacles", json={"x": 5, "y": -1, "size_m": 0.3}).json()
        address = f"{SITE}/obstacles/{made['id']}"
        next(news)
        assert second.get(f"{SITE}/map").json()["obstacles"] == [made]

        def move_about(client: httpx.Client, y: float) -> None:
            for number in range(20):
                moved = client.put(address, json={"x": 5 + number / 100, "y": y, "size_m": 0.3})
                assert moved.status_code == 200, moved.text

        with ThreadPoolExecutor(2) as people:
            list(people.map(move_about, (first, second), (-1.25, -1.5)))
        seen = [client.get(f"{SITE}/map").json()["obstacles"] for client in (first, second)]
        assert seen[0] == seen[1]
        assert seen[0] in [[{**made, "x": 5.19, "y": y}] for y in (-1.25, -1.5)]
        assert second.delete(address).status_code == 204
        late = first.put(address, json={"x": 5, "y": -1})
        assert (late.status_code, late.json()["code"]) == (404, "no_such_obstacle")
        news.close()


def test_a_floor_check_at_one_web_process_knows_the_zone_that_was_drawn_at_the_other(served: Served) -> None:
    with served.signed_in("author", 0) as first, served.signed_in("admin", 1) as second:
        assert [client.get(f"{SITE}/floor-check").json()["findings"] for client in (first, second)] == [[], []]
        points = [[8.0, -13.5], [14.0, -13.5], [14.0, -8.5], [8.0, -8.5]]
        made = second.post(f"{SITE}/zones", json={"name": "Wet", "rule": "keep_out", "points": points}).json()
        try:
            found = first.get(f"{SITE}/floor-check").json()["findings"]
            assert {each["other"] for each in found} == {made["id"]}
        finally:
            assert second.delete(f"{SITE}/zones/{made['id']}").status_code == 204
        assert first.get(f"{SITE}/floor-check").json()["findings"] == []


def test_a_pick_and_drop_runs_to_its_end_with_two_workers(served: Served) -> None:
    with served.signed_in("author", 0) as first, served.signed_in("admin", 1) as second:
        before = devices(first)
        run = start_task(served, first)
        done = served.wait("the end of the run", lambda: over(second, run), 180)
        assert (done["status"], done["reason"]) == ("finished", ""), served.story()
        assert {step["status"] for step in done["steps"].values()} == {"done"}
        kinds = [event["kind"] for event in second.get(f"/api/runs/{run}/events").json()]
        assert kinds
        after = devices(second)
        assert stock(after, "itemInventory01") < stock(before, "itemInventory01")
    logs = [served.log(f"worker-{n}").read_text() for n in (1, 2)]
    assert any("drive_site" in log for log in logs), "no worker has carried the site out"


def rehearse_endlessly(clients: list[httpx.Client], times: int) -> list[str]:
    """Queue so many rehearsals of a program that does not end, for each of these people; return their ids."""
    programs = clients[0].get(f"{SITE}/programs").json()
    endless = next(program for program in programs if program["name"] == "Endless")
    answers = [client.post(f"/api/programs/{endless['id']}/rehearsals", json={}) for client in clients * times]
    assert [answer.status_code for answer in answers] == [202] * len(answers), answers[0].text
    return [answer.json()["id"] for answer in answers]


def test_a_run_goes_on_beside_eight_rehearsals_that_never_end_and_they_end_when_cancelled(served: Served) -> None:
    with served.signed_in("author", 0) as author, served.signed_in("admin", 1) as admin:
        rehearsals = rehearse_endlessly([author, admin], 4)
        served.wait("one under way", lambda: author.get(f"{SITE}/rehearsals").json()[0]["course"])
        run = start_task(served, author)
        done = served.wait("the end of the run", lambda: over(admin, run), 400)
        assert (done["status"], done["reason"]) == ("finished", ""), served.story()
        left = [each["status"] for each in author.get(f"{SITE}/rehearsals").json()]
        assert {"running", "queued"} == set(left), "the run did not wait for them"
        for rehearsal in rehearsals:
            admin.post(f"/api/rehearsals/{rehearsal}/cancel")
        assert author.get(f"{SITE}/rehearsals").json() == []
    logs = [served.log(f"worker-{n}").read_text() for n in (1, 2)]
    assert [log for log in logs if "execution.tasks.rehearse" in log.partition("ready.")[2]] == []


@pytest.mark.parametrize("sse", [False, True])
def test_a_foreign_client_reads_observes_and_invokes_at_another_process_than_its_token_was_made(
    served: Served, sse: bool
) -> None:
    with served.signed_in("admin", 0) as admin:
        wait_for_mixer(admin)
        token = make_token(admin, "operate")
    check_story(run_client(f"http://127.0.0.1:{served.web_ports[1]}", token, sse=sse))


def test_a_foreign_client_observes_over_mqtt_and_may_do_nothing_else_there(served: Served, tmp_path: Path) -> None:
    with served.signed_in("admin", 0) as admin:
        wait_for_mixer(admin)
        address = f"http://127.0.0.1:{served.web_ports[1]}"
        check_observer(admin, address, tmp_path, served.mosquitto.authority)


def test_a_run_survives_the_death_of_a_worker_and_of_the_gateway(served: Served) -> None:
    with served.signed_in("author", 1) as client:
        run = start_task(served, client)
        served.wait("the start", lambda: client.get(f"/api/runs/{run}").json()["status"] == "running")
        served.kill("worker-1")
        served.kill("gateway")
        served.start("gateway", "manage.py", "gateway")
        served.start("worker-1", *WORKER, "-n", "worker-1@%h")
        done = served.wait("the end of the run", lambda: over(client, run), 180)
        assert (done["status"], done["reason"]) == ("finished", ""), served.story()


def plan_waits(client: httpx.Client, begin: datetime) -> list[str]:
    """Plan runs of a program that only waits: they matter little and much, and are due before they can be over."""
    programs = client.get(f"{SITE}/programs").json()
    waits = next(program for program in programs if program["name"] == "Wait")
    runs = []
    for priority in ("low", "high", "normal", "high"):
        due = begin + timedelta(seconds=DUE_S)
        terms = {"priority": priority, "not_before": begin.isoformat(), "deadline": due.isoformat()}
        answer = client.post(f"/api/programs/{waits['id']}/runs", json=terms)
        assert answer.status_code == 202, answer.text
        assert terms.items() <= answer.json().items()
        runs.append(str(answer.json()["id"]))
    return runs


def test_planned_runs_begin_once_at_their_time_though_workers_die_while_they_wait(served: Served) -> None:
    with served.signed_in("author", 0) as client:
        begin = datetime.now(UTC) + timedelta(seconds=30)
        runs = plan_waits(client, begin)
        served.kill("worker-1")
        assert [client.get(f"/api/runs/{run}").json()["status"] for run in runs] == ["pending"] * 4
        served.start("worker-1", *WORKER, "-n", "worker-1@%h")
        for run in runs:
            served.wait("its start", lambda r=run: client.get(f"/api/runs/{r}").json()["status"] != "pending")
        served.kill("worker-2")
        served.start("worker-2", *WORKER, "-n", "worker-2@%h")
        for run in runs:
            done = served.wait("its end", lambda r=run: over(client, r), 120)
            assert (done["status"], done["reason"]) == ("finished", ""), served.story()
            assert datetime.fromisoformat(done["started_at"]) >= begin
            codes = [event["code"] for event in client.get(f"/api/runs/{run}/events").json()]
            told = [code for code in codes if code in {"started_planned", "deadline_passed", "finished"}]
            assert told == ["started_planned", "deadline_passed", "finished"], codes
        shown = {run["id"]: run["priority"] for run in client.get(f"{SITE}/runs").json()}
        assert [shown[run] for run in runs] == ["low", "high", "normal", "high"]


def test_one_web_process_tells_of_all_and_of_a_gateway_that_freezes_and_comes_back(served: Served) -> None:
    def of(name: str) -> set[str]:
        told = httpx.get(f"http://127.0.0.1:{served.web_ports[1]}/metrics", timeout=PATIENCE_S).text.splitlines()
        return {line for line in told if line.startswith(name)}

    def beating() -> list[str]:
        lines = [line for line in of("vipo_process_beat_age_seconds") if 'state="beats"' in line]
        return sorted({line.split('"')[1] for line in lines})

    with served.signed_in("author") as client:
        path, call = f"{SITE}/devices/paintMixer01", {"method": "dispense", "args": {"object": "can", "value": 1}}
        served.wait("the mixer", lambda: client.get(path).json()["status"] == "idle", 120)
        answer = client.post(f"{path}/call", json=call)
        assert answer.status_code == 202, answer.text
    served.wait("every kind", lambda: beating() == ["gateway", "ticker", "twin", "web", "worker"])
    served.wait("its work", lambda: any("drive_site" in line and "SUCCESS" in line for line in of("vipo_tasks_total")))
    served.wait("its answers", lambda: of("vipo_command_answers_total{"))
    served.wait("nothing to find: a heartbeat may be late on a busy machine", lambda: not of("vipo_findings{"))
    frozen = next(process for name, process in served.processes.items() if name.startswith("gateway"))
    frozen.send_signal(signal.SIGSTOP)
    try:
        served.wait("silence", lambda: any('code="no_gateway"' in line for line in of("vipo_findings{")))
        with served.signed_in("admin") as client:

            def found() -> list[str]:
                return [each["code"] for each in client.get(f"{SITE}/findings").json()]

            served.wait("the gateway's silence alone", lambda: found() == ["no_gateway", "process_silent"])
    finally:
        frozen.send_signal(signal.SIGCONT)
    served.wait("its next beat", lambda: not of("vipo_findings{"))


def test_every_process_ends_when_it_is_asked(served: Served) -> None:
    codes = served.stop_all()
    assert set(codes) == {"web-1", "web-2", "worker-1", "worker-2", "rehearsals", "gateway", "ticker", "twin"}
    assert {name: codes[name] for name in ("gateway", "ticker", "twin", "worker-1", "rehearsals")} == {
        "gateway": 0,
        "ticker": 0,
        "twin": 0,
        "worker-1": 0,
        "rehearsals": 0,
    }


def over(client: httpx.Client, run: str) -> dict[str, Any] | None:
    found: dict[str, Any] = client.get(f"/api/runs/{run}").json()
    return found if found["status"] in OVER else None


def stock(found: dict[str, Any], device: str) -> float:
    value = next(p["value"] for p in found[device]["properties"] if p["name"] == "stock")
    return float(value)
