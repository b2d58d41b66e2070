"""Carrying out a site: whoever has its lease takes turn after turn while there is work, then gives it up.

A second one that comes meanwhile has nothing to do, and who was frozen finds that it owns nothing any more.
"""

from __future__ import annotations

import logging
import threading
import time
from collections import OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager

from django.db import DatabaseError, InterfaceError, OperationalError, connection

from execution import mailbox
from execution.engine import lease as leases
from execution.engine.commit import Outdated, commit
from execution.engine.inbox import MOST_AT_ONCE, read_news
from execution.engine.lease import Lease, LeaseLost
from execution.engine.lease_renewal import renewal
from execution.engine.memory import SiteMemory, read_site
from execution.engine.poison import set_row_aside, set_run_aside
from execution.engine.turn import Turn
from execution.fault_points import fault_point
from execution.frozen_sessions import OWNER_SILENT_S
from execution.models import InboxEvent
from registry import services as registry

log = logging.getLogger(__name__)
LINGER_S = 2.0
STAY_S = 60.0
LOOK_EVERY_S, LOOK_AT_ONCE_S = 0.5, 0.1
"""Devices are looked at twice a second, and at most ten times when they say that something is new."""
AGAIN_S = 0.05
SITES_REMEMBERED = 16
SESSION_ENDED = "25P03"
"""By this code PostgreSQL says that it has ended a transaction in which nothing was asked for OWNER_SILENT_S."""

_memories: OrderedDict[str, SiteMemory] = OrderedDict()
_driven: set[str] = set()
_guard = threading.Lock()
leaving = threading.Event()
"""Set when this process is to end: every site is handed over at once."""


def drive_site(slug: str, *, stay_s: float = STAY_S, linger_s: float = LINGER_S) -> bool:
    """Carry out a site's runs while there is work; False when somebody else does, or the site is not there."""
    if leaving.is_set():
        mailbox.send_hint(mailbox.DRIVE_SITE, slug)
        return False
    with _alone(slug) as is_alone:
        if not is_alone:
            return False
        try:
            site = registry.get_site_id(site=slug)
            _limit_session()
            lease = leases.take(site)
            if lease is None:
                return False
            return _own(slug, lease, stay_s, linger_s)
        except registry.NotAMember:
            return False
        except (OperationalError, InterfaceError) as error:
            log.warning("The owner of %s lost the database; the ticker calls another one: %s", slug, error)
            _forget(slug)
            connection.close()
            return False


def advance_site(slug: str, *, look: bool = True) -> bool:
    """Take turns at a site until nothing moves, and give it up; False when somebody else owns it.

    The first turn looks at the devices, unless `look` says that nothing is new of them.
    """
    with _alone(slug) as is_alone:
        lease = leases.take(registry.get_site_id(site=slug)) if is_alone else None
        if lease is None:
            return False
        try:
            _take_turns(slug, lease, look=look)
        finally:
            leases.release(lease)
    return True


def leave() -> None:
    """Hand every site over, since this process is to end; returns at once."""
    leaving.set()
    with _guard:
        driven = list(_driven)
    for slug in driven:
        registry.wake(mailbox.site_target(slug))


def forget_all() -> None:
    """Forget what is known of every site, such as when another database is used from now on."""
    _memories.clear()
    leaving.clear()


@contextmanager
def _alone(slug: str) -> Iterator[bool]:
    """Keep other threads of this process, which the lease does not tell apart, from the same site."""
    with _guard:
        is_free = slug not in _driven
        if is_free:
            _driven.add(slug)
    try:
        yield is_free
    finally:
        if is_free:
            with _guard:
                _driven.discard(slug)


def _limit_session() -> None:
    if connection.vendor == "postgresql":
        with connection.cursor() as cursor:
            cursor.execute(f"SET idle_in_transaction_session_timeout = '{OWNER_SILENT_S:g}s'")


def _own(slug: str, lease: Lease, stay_s: float, linger_s: float) -> bool:
    """Stay with a site, then give it up and see to it that somebody goes on where there is more to do."""
    try:
        with renewal.keeping(lease):
            has_more = _stay(slug, lease, stay_s, linger_s)
        fault_point("before_hand_over")
        leases.release(lease)
        fault_point("after_hand_over")
    except LeaseLost:
        log.warning("Another process carries out the runs of %s.", slug)
        _forget(slug)
        return False
    if has_more or InboxEvent.objects.filter(site=slug, taken_at=None).exists():
        mailbox.send_hint(mailbox.DRIVE_SITE, slug)
    return True


def _stay(slug: str, lease: Lease, stay_s: float, linger_s: float) -> bool:
    """Take turns while there is work; True when it was time to go before it was done."""
    began = busy_at = time.monotonic()
    looked_at = float("-inf")
    while True:
        now = time.monotonic()
        if leaving.is_set() or now - began >= stay_s or renewal.others_wait(since=busy_at):
            return True
        memory = _memory(slug, lease)
        is_told = registry.wait_wake(mailbox.look_channel(slug), 0) and now - looked_at >= LOOK_AT_ONCE_S
        look = memory.is_watching and (is_told or now - looked_at >= LOOK_EVERY_S)
        if look:
            looked_at = now
        renewal.note_turn(lease)
        if _turn(slug, lease, look=look):
            busy_at = time.monotonic()
            # whoever posts something calls, also during the turn; one look more is for a call that was lost
            registry.wait_wake(mailbox.site_target(slug), 0 if memory.has_more else AGAIN_S)
            continue
        memory = _memory(slug, lease)
        if not memory.is_watching and memory.wakes_at is None and time.monotonic() - busy_at >= linger_s:
            return False
        registry.wait_wake(mailbox.site_target(slug), _rest(memory, looked_at))


def _rest(memory: SiteMemory, looked_at: float) -> float:
    """Return how long there is nothing to do unless somebody calls."""
    now = time.monotonic()
    rest = looked_at + LOOK_EVERY_S - now if memory.is_watching else LOOK_EVERY_S
    if memory.wakes_at is not None:
        rest = min(rest, memory.wakes_at - now)
    return min(max(rest, 0.005), LOOK_EVERY_S)


def _take_turns(slug: str, lease: Lease, *, look: bool) -> None:
    """Take turns until nothing moves."""
    while _turn(slug, lease, look=look) or look:
        look = False


def _turn(slug: str, lease: Lease, *, look: bool) -> bool:
    """Take one turn; True when it has changed something."""
    memory = _memory(slug, lease)
    memory.wakes_at = None if memory.wakes_at and memory.wakes_at <= time.monotonic() else memory.wakes_at
    news = read_news(lease.site, slug, memory.last_number, memory.most_at_once)
    if news.floor_epoch != memory.floor_row.epoch:
        _forget(slug)
        memory = _memory(slug, lease)
    memory.add_started(news.runs)
    turn = Turn(memory, news, look=look)
    try:
        turn.work_out()
        moved = commit(turn, lease)
        memory.has_more = turn.has_more or len(news.rows) >= memory.most_at_once
    except LeaseLost:
        raise
    except Outdated as error:
        log.info("A turn of %s is taken again: %s", slug, error)
        _forget(slug)
        return True
    except (OperationalError, InterfaceError):
        raise
    except Exception as error:  # one thing that cannot be written must not stop its site
        if getattr(error.__cause__, "sqlstate", None) == SESSION_ENDED:
            # It was frozen in its transaction. Nothing is wrong with what was to be written: it is not set aside.
            raise OperationalError(f"The database has ended the session: {error}") from error
        return _take_apart(slug, turn, lease, error)
    memory.most_at_once = MOST_AT_ONCE
    return moved


def _take_apart(slug: str, turn: Turn, lease: Lease, error: Exception) -> bool:
    """Find out what the database does not take: what a run does of itself, or else which message, one at a time."""
    log.error("A turn of %s could not be written.", slug, exc_info=error)
    _forget(slug)
    if isinstance(error, DatabaseError):
        connection.close_if_unusable_or_obsolete()
    if set_run_aside(turn, lease):
        return True
    if len(turn.rows) > 1:
        _memory(slug, lease).most_at_once = 1
        return True
    if turn.rows:
        set_row_aside(turn.rows[0], lease, turn.now, error)
        return True
    return False


def _memory(slug: str, lease: Lease) -> SiteMemory:
    """Return what is known of the site; it is read anew when another owner was there in between."""
    memory = _memories.get(slug)
    if memory is None or memory.epoch != lease.epoch or memory.site.pk != lease.site:
        memory = _memories[slug] = read_site(slug, lease.epoch)
        while len(_memories) > SITES_REMEMBERED:
            other = next((each for each in _memories if each not in _driven), None)
            if other is None:
                break
            _forget(other)
    return memory


def _forget(slug: str) -> None:
    _memories.pop(slug, None)
