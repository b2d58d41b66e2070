"""What the embedded broker bears from clients that do not read, do not stop, or do not begin."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from datetime import UTC, datetime

import pytest

from registry import services
from tests.integration.wire.raw import Notebook, Raw, connect, field, packet, publish, raw, subscribe
from tests.kit.files import MIXER_TEXT
from tests.kit.mqtt import Ear
from tests.kit.waiting import wait_for
from vipo_site.embedded_broker.access_control import RegistryAccess
from vipo_site.embedded_broker.server import EmbeddedBroker

WORD, SERVER_WORD = "word", "secret"
UP, DOWN = "vipo/v1/dev/loud01/up/", "vipo/v1/dev/loud01/down/"
MOST_TAKEN_BYTES = 16_000_000
FLOOD = publish("vipo/v1/dev/loud01/up/x" + "y" * 3000, b"", qos=1) + b"\xc0\x00" * 500
FILLER = b"x" * 12_000


@pytest.fixture
def notebook() -> Notebook:
    return Notebook(WORD)


@pytest.fixture
def broker(notebook: Notebook) -> Iterator[EmbeddedBroker]:
    running = EmbeddedBroker(host="127.0.0.1", port=0, server_password=SERVER_WORD, access_control=notebook)
    running.start()
    yield running
    running.stop()
    assert not running.running


@pytest.fixture
def ear(broker: EmbeddedBroker) -> Iterator[Ear]:
    with Ear(broker.port, SERVER_WORD) as listening:
        assert listening.client.wait_subscribed(20)
        yield listening


def stands_still(number: Callable[[], int]) -> bool:
    """Tell whether a number is the same after a second."""
    before = number()
    time.sleep(1)
    return number() == before


def others_go_on(broker: EmbeddedBroker, ear: Ear, word: str) -> None:
    """A calm device says something, and it is heard."""
    with raw(broker, connect("calm01", WORD)) as calm:
        calm.send(publish("vipo/v1/dev/calm01/up/state", word.encode(), qos=1))
        assert calm.read() == (0x40, b"\x00\x01")
    ear.wait(lambda h: h.payload == word.encode(), 20)


def test_what_a_client_does_not_read_is_dropped_and_counted(
    broker: EmbeddedBroker, notebook: Notebook, ear: Ear
) -> None:
    with raw(broker, connect("loud01", WORD)) as deaf, raw(broker, connect("s", SERVER_WORD, user="server")) as server:
        deaf.send(subscribe(1, DOWN + "#"))
        assert deaf.read() == (0x90, b"\x00\x01\x01")
        for _ in range(8000):
            server.send(publish(DOWN + "move", FILLER))
        others_go_on(broker, ear, "here")
        wait_for("what the broker notes", lambda: notebook.dropped["loud01"] > 6000)
    assert notebook.lines == [("loud01", "too many messages wait for it: some were dropped")]


def test_an_absent_client_with_a_session_gets_the_first_thousand(broker: EmbeddedBroker, notebook: Notebook) -> None:
    hello = connect("loud01", WORD, clean=False)
    with raw(broker, hello) as first:
        first.send(subscribe(1, DOWN + "#"))
        assert first.read() == (0x90, b"\x00\x01\x01")
        first.send(b"\xe0\x00")
        assert first.closed()
    with raw(broker, connect("s", SERVER_WORD, user="server")) as server:
        for number in range(3000):
            server.send(publish(DOWN + "move", b"%d" % number))
        wait_for("what the broker notes", lambda: notebook.dropped["loud01"] == 2000)
    with raw(broker, hello, b"\x01\x00") as again:
        topic = field(DOWN + "move")
        unacknowledged = [again.read() for _ in range(20)]
    with raw(broker, hello, b"\x01\x00") as again:
        heard = []
        for _ in range(1000):
            head, body = again.read()
            heard.append((head, body[len(topic) + 2 :]))
            again.send(packet(0x40, body[len(topic) :][:2]))
    assert unacknowledged == [(0x32, topic + bytes((0, n + 1)) + b"%d" % n) for n in range(20)]
    assert heard == [(0x3A if n < 20 else 0x32, b"%d" % n) for n in range(1000)]


def test_a_flood_by_one_who_reads_no_answers_holds_up_itself_alone(broker: EmbeddedBroker, ear: Ear) -> None:
    with raw(broker, connect("loud01", WORD), room=4096) as loud:
        stop, sent = threading.Event(), [0]

        def flood() -> None:
            with suppress(OSError):
                while not stop.is_set():
                    loud.send(FLOOD)
                    sent[0] += len(FLOOD)

        thread = threading.Thread(target=flood)
        thread.start()
        for number in range(5):
            others_go_on(broker, ear, f"here {number}")
            time.sleep(0.1)
        wait_for("the end of what is taken from it", lambda: stands_still(lambda: sent[0]))
        assert sent[0] < MOST_TAKEN_BYTES
        stop.set()
        loud.socket.shutdown(2)
        thread.join(20)
        assert not thread.is_alive()


def test_a_giant_packet_ends_its_connection_with_its_will(broker: EmbeddedBroker, notebook: Notebook, ear: Ear) -> None:
    with raw(broker, connect("loud01", WORD, will=(UP + "presence", "gone"))) as loud:
        loud.send(b"\x30\xff\xff\xff\x7f" + b"x" * 1000)
        assert loud.closed()
    ear.wait(lambda h: h.payload == b"gone")
    wait_for("what the broker notes", lambda: notebook.lines)
    assert notebook.lines == [("loud01", "a packet of more than 16384 bytes ended its connection")]
    with raw(broker, connect("loud01", WORD)) as loud:
        loud.send(publish(UP + "state", b"x" * (16384 - 4 - len(field(UP + "state"))), qos=0) + b"\xc0\x00")
        assert loud.read() == (0xD0, b"")


def test_of_a_devices_retained_topics_sixty_four_are_kept(broker: EmbeddedBroker, notebook: Notebook) -> None:
    with raw(broker, connect("loud01", WORD)) as loud:
        for number in range(2000):
            loud.send(publish(f"{UP}t{number}", b"kept", retain=True))
        loud.send(publish(f"{UP}t0", b"", retain=True))
        loud.send(publish(f"{UP}last", b"kept", retain=True))
        loud.send(publish(f"{UP}t1", b"anew", retain=True) + b"\xc0\x00")
        assert loud.read() == (0xD0, b"")
    wait_for("what the broker notes", lambda: notebook.dropped["loud01"] == 1936)
    with Ear(broker.port, SERVER_WORD) as ear:
        assert ear.client.wait_subscribed(20)
        wait_for("what the broker notes", lambda: len(ear.heard) == 64)
        kept = {h.topic.rsplit("/", 1)[1]: h.payload for h in ear.heard}
    assert kept == {f"t{n}": b"kept" for n in range(2, 64)} | {"t1": b"anew", "last": b"kept"}
    assert notebook.lines == [("loud01", "more than 64 retained topics: some were not kept")]


def test_five_hundred_subscriptions_are_taken(broker: EmbeddedBroker, notebook: Notebook) -> None:
    filters = [f"{DOWN}{number}" for number in range(510)]
    with raw(broker, connect("loud01", WORD)) as loud:
        loud.send(subscribe(1, *filters[:300]) + subscribe(2, *filters[300:]))
        answers = loud.read()[1][2:] + loud.read()[1][2:]
        assert answers == b"\x01" * 500 + b"\x80" * 10
        loud.send(packet(0xA2, b"\x00\x03", *(field(each) for each in filters[:300])))
        assert loud.read() == (0xB0, b"\x00\x03")
        loud.send(subscribe(4, *filters[500:], DOWN + "/" * 250))
        assert loud.read() == (0x90, b"\x00\x04" + b"\x01" * 10 + b"\x80")
    wait_for("what the broker notes", lambda: notebook.dropped["loud01"] == 11)


def test_connections_that_never_begin_make_room_for_those_that_do(
    broker: EmbeddedBroker, ear: Ear, monkeypatch: pytest.MonkeyPatch
) -> None:
    silent = [Raw(broker, b"\x10") for _ in range(150)]
    others_go_on(broker, ear, "here")
    assert [each.closed() for each in silent[:50]] == [True] * 50
    monkeypatch.setattr("vipo_site.embedded_broker.broker.CONNECT_TIMEOUT_S", 0.3)
    drip = Raw(broker, b"\x10\x40")
    with suppress(OSError):
        for _ in range(20):
            drip.send(b"\x00")
            time.sleep(0.05)
    assert drip.closed()
    for each in (*silent, drip):
        each.socket.close()


def test_a_packet_that_never_ends_counts_as_silence(broker: EmbeddedBroker, ear: Ear) -> None:
    will = (UP + "presence", "gone")
    with raw(broker, connect("loud01", WORD, keepalive_s=1, will=will)) as loud:
        loud.send(b"\x30\x80\x01\x00\x10")
        with suppress(OSError):
            for _ in range(40):
                loud.send(b"x")
                time.sleep(0.05)
        ear.wait(lambda h: h.payload == b"gone", 20)
        assert loud.closed()


def test_a_message_without_a_proper_topic_ends_the_connection_and_the_session(broker: EmbeddedBroker, ear: Ear) -> None:
    for number, topic in enumerate((UP + "+", "$SYS/x", "", UP + "\0")):
        with raw(broker, connect("loud01", WORD, will=(UP + "presence", f"gone {number}"))) as loud:
            loud.send(publish(topic, b"x"))
            assert loud.closed()
    ear.wait(lambda h: h.payload == b"gone 3")
    assert [h.payload for h in ear.heard] == [b"gone %d" % number for number in range(4)]


def test_a_message_of_qos_2_is_heard_once(broker: EmbeddedBroker, ear: Ear) -> None:
    with raw(broker, connect("loud01", WORD)) as loud:
        for number in (7, 7, 8):
            loud.send(publish(UP + "ack", b"%d" % number, qos=2, number=number))
            assert loud.read() == (0x50, bytes((0, number)))
        loud.send(packet(0x62, b"\x00\x07") + publish(UP + "ack", b"7 again", qos=2, number=7))
        assert [loud.read(), loud.read()] == [(0x70, b"\x00\x07"), (0x50, b"\x00\x07")]
    ear.wait(lambda h: h.payload == b"7 again")
    assert [h.payload for h in ear.heard] == [b"7", b"8", b"7 again"]


@pytest.mark.parametrize(
    ("hello", "why"),
    [
        (connect("ear", WORD, clean=False), "ear (user ear): the server itself uses this name."),
        (connect("a", WORD, user="b"), "a (user b): a device's client id and its user name must both be its id."),
        (connect("a", WORD, will=("vipo/x", "")), "a (user a): its last will is not on a topic of its own."),
        (connect("a", "wrong"), "a (user a): wrong password, or nobody of this name."),
        (connect("a", "wrong", user="server"), "a (user server): wrong password."),
        (
            connect("a\n\x1b[2J" + "b" * 99, "wrong"),
            f"a\ufffd\ufffd[2J{'b' * 74} (user a\ufffd\ufffd[2J{'b' * 74}): wrong password, or nobody of this name.",
        ),
    ],
)
def test_who_is_refused_is_told_to_the_log_with_the_reason(
    broker: EmbeddedBroker, ear: Ear, caplog: pytest.LogCaptureFixture, hello: bytes, why: str
) -> None:
    imposter = Raw(broker, hello)
    assert imposter.read() == (0x20, b"\x00\x05")
    assert imposter.closed()
    imposter.socket.close()
    assert ear.client.connected
    assert f"MQTT: refused {why}" in caplog.messages


def test_a_client_that_reads_nothing_is_ended(
    broker: EmbeddedBroker, ear: Ear, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("vipo_site.embedded_broker.connection.STUCK_S", 0.5)
    with raw(broker, connect("loud01", WORD, keepalive_s=0, will=(UP + "presence", "gone"))) as deaf:
        deaf.send(subscribe(1, DOWN + "#", qos=0))
        assert deaf.read() == (0x90, b"\x00\x01\x00")
        with raw(broker, connect("s", SERVER_WORD, user="server")) as server:
            for _ in range(2000):
                server.send(publish(DOWN + "move", FILLER))
            ear.wait(lambda h: h.payload == b"gone", 20)


def test_a_message_on_a_foreign_topic_is_noted(broker: EmbeddedBroker, notebook: Notebook) -> None:
    with raw(broker, connect("loud01", WORD)) as loud:
        loud.send(publish("vipo/v1/dev/other/up/st\n\x1bate", b"x"))
        wait_for("what the broker notes", lambda: notebook.lines)
    assert notebook.lines == [("loud01", "not its own topic: vipo/v1/dev/other/up/st\ufffd\ufffdate")]


@pytest.mark.django_db(transaction=True)
def test_the_registry_shows_what_was_dropped() -> None:
    site = services.create_site(name="Hall", slug="painting-factory")
    text = MIXER_TEXT.encode()
    services.ingest_description(device_id="paintMixer03", payload=text, at=datetime.now(UTC))
    RegistryAccess().record(
        {"paintMixer03": 7, "server": 2}, [("paintMixer03", "7 were dropped", {}), ("server", "x", {})]
    )
    device = services.get_device(site=site.slug, device_id="paintMixer03")
    events = services.list_device_events(site=site.slug, device_id="paintMixer03")
    assert (device.dropped, events[0].text) == (7, "7 were dropped")
