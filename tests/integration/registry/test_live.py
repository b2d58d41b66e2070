from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import redis

from registry.live import fanout as port
from registry.live.fanout import Live, RedisLive, make_live
from tests.kit.servers import Redis, run_redis
from tests.kit.waiting import wait_for


@pytest.fixture(params=["memory", "redis"])
def live(request: pytest.FixtureRequest) -> Iterator[Live]:
    url = "memory://" if request.param == "memory" else request.getfixturevalue("shared_redis").url
    made = make_live(url)
    yield made
    made.close()


def test_every_listener_hears_every_site_in_order(live: Live) -> None:
    first: list[Any] = []
    second: list[Any] = []
    live.listen(lambda slug, message: first.append((slug, message)))
    stop = live.listen(lambda slug, message: second.append((slug, message)))
    for number in range(20):
        live.publish("a", {"n": number})
    live.publish("b", {"ä": [1.5, None]})
    wait_for("the messages", lambda: len(first) == 21 and len(second) == 21)
    assert first == second == [*(("a", {"n": n}) for n in range(20)), ("b", {"ä": [1.5, None]})]
    stop()
    live.publish("a", {"n": 99})
    wait_for("the messages", lambda: len(first) == 22)
    assert len(second) == 21


def test_a_listener_that_fails_does_not_keep_the_message_from_others(
    live: Live, caplog: pytest.LogCaptureFixture
) -> None:
    heard: list[Any] = []

    def fail(slug: str, message: Any) -> None:
        raise ValueError("broken")

    live.listen(fail)
    live.listen(lambda slug, message: heard.append(message))
    live.publish("a", {"n": 1})
    wait_for("the messages", lambda: heard == [{"n": 1}])
    assert "A listener failed" in caplog.text


def test_what_a_listener_does_to_a_message_is_its_own_affair(live: Live) -> None:
    heard: list[Any] = []
    live.listen(lambda slug, message: message.clear())  # type: ignore[attr-defined]
    live.listen(lambda slug, message: heard.append(message))
    live.publish("a", {"n": 1})
    wait_for("the messages", lambda: heard == [{"n": 1}])


def test_a_hint_wakes_who_waits(live: Live) -> None:
    woken: list[str] = []
    waiting = threading.Event()

    def wait() -> None:
        live.wait_wake("gateway", 0.01)
        waiting.set()
        if live.wait_wake("gateway", 60):
            woken.append("gateway")

    thread = threading.Thread(target=wait)
    thread.start()
    assert waiting.wait(60)
    live.wake("other")
    time.sleep(0.2)
    assert not woken
    live.wake("gateway")
    thread.join(60)
    assert len(woken) == 1


def test_a_hint_given_between_two_waits_is_not_lost(live: Live) -> None:
    assert live.wait_wake("ticker", 0.01) is False
    live.wake("ticker")
    time.sleep(0.1)
    assert live.wait_wake("ticker", 60) is True
    assert live.wait_wake("ticker", 0.05) is False


def test_a_subscription_gives_one_sites_messages_in_the_event_loop(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(port, "live", lambda: live)

    async def read() -> list[Any]:
        async with port.subscribe("a") as messages:
            await asyncio.to_thread(live.publish, "b", {"n": 0})
            await asyncio.to_thread(live.publish, "a", {"n": 1})
            return [await asyncio.wait_for(messages.get(), 60)]

    assert asyncio.run(read()) == [{"n": 1}]
    live.publish("a", {"n": 2})


def test_a_full_subscription_drops_the_oldest(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(port, "live", lambda: live)

    async def read() -> list[Any]:
        async with port.subscribe("a", limit=2) as messages:
            heard: list[Any] = []
            live.listen(lambda _slug, message: heard.append(message))  # it hears each one after the subscription
            for number in range(5):
                live.publish("a", {"n": number})
            await asyncio.to_thread(wait_for, "the messages", lambda: len(heard) == 5)
            await asyncio.sleep(0.1)
            return [messages.get_nowait(), messages.get_nowait()]

    assert asyncio.run(read()) == [{"n": 3}, {"n": 4}]


def test_after_a_gap_watchers_are_told_to_begin_anew(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    heard: list[Any] = []
    with run_redis(tmp_path) as redis:
        live = RedisLive(redis.url)
        live.listen(lambda slug, message: heard.append((slug, message)))
        clients: list[Any] = wait_for("the listener", lambda: [c for c in live._redis.client_list() if int(c["psub"])])
        live._redis.client_kill_filter(_id=clients[0]["id"])
        wait_for("the messages", lambda: ("", {"type": "hello"}) in heard)
        live.publish("a", {"n": 1})
        wait_for("the messages", lambda: ("a", {"n": 1}) in heard)
        redis.process.kill()
        redis.process.wait()
        live.publish("a", {"n": 2})
        live.wake("gateway")
        # Whoever noticed first, a thread of its own perhaps, is just about to say so.
        wait_for("the messages", lambda: caplog.text.count("Redis does not answer") == 2)
    live.close()
    assert caplog.text.count("Redis does not answer") == 2


def test_who_waits_for_hints_of_one_kind_is_not_told_those_of_others(shared_redis: Redis) -> None:
    live = RedisLive(shared_redis.url)
    try:
        with redis.Redis.from_url(shared_redis.url) as other:
            before = [other.publish(f"vipo:wake:{channel}", "") for channel in ("site:a", "gateway")]
            assert live.wait_wake("site:b", 0) is False
            after = [other.publish(f"vipo:wake:{channel}", "") for channel in ("site:a", "gateway")]
        assert [now - then for now, then in zip(after, before, strict=True)] == [1, 0]
    finally:
        live.close()
