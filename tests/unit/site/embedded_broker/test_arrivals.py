"""How often somebody may come in to the embedded broker."""

from __future__ import annotations

from vipo_site.embedded_broker.arrivals import COMES_AT_ONCE, MOST_KNOWN, Arrivals

BURST = int(COMES_AT_ONCE)


def come(arrivals: Arrivals, times: int, now: float, username: str = "robot01") -> int:
    """Return how many of so many attempts with the right key came in."""
    admitted = 0
    for _ in range(times):
        if arrivals.may_come(username, "10.0.0.1", now):
            arrivals.note_admitted(username, now)
            admitted += 1
    return admitted


def test_seventy_connections_a_second_of_one_key_are_one_a_second_after_the_first_thirty() -> None:
    arrivals = Arrivals()
    assert [come(arrivals, 70, now=float(second)) for second in range(5)] == [BURST, 1, 1, 1, 1]
    assert come(arrivals, 1, 4.0, "robot02") == 1
    assert come(arrivals, 70, now=1000.0) == BURST


def test_a_stranger_with_a_wrong_key_keeps_nobody_else_out() -> None:
    arrivals = Arrivals()
    for _ in range(BURST):
        assert arrivals.may_come("robot01", "10.0.0.66", 0.0)
        arrivals.note_refused("robot01", "10.0.0.66", 0.0)
    assert not arrivals.may_come("robot01", "10.0.0.66", 0.0)
    assert arrivals.may_come("robot02", "10.0.0.66", 0.0)
    assert come(arrivals, 1, 0.0) == 1


def test_the_server_itself_is_not_bounded_and_memory_is() -> None:
    arrivals = Arrivals()
    assert come(arrivals, 1000, 0.0, "server") == 1000
    for number in range(2 * MOST_KNOWN):
        arrivals.note_refused(f"n{number}", "10.0.0.1", 0.0)
    assert len(arrivals._buckets) == MOST_KNOWN
