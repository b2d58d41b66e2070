"""One turn of a site: what is new goes through its runs and its floor in memory until nothing moves."""

from __future__ import annotations

import logging
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from django.db import DatabaseError, InterfaceError

from execution.engine.dead_letter_capture import (
    ByHand,
    SetAside,
    cancel_by_hand,
    log_ids_of,
    pause_by_hand,
    pause_for,
    run_of,
    several,
    without_tasks_of_one,
    words_of,
)
from execution.engine.holding import Mail, held_for
from execution.engine.inbox import News, Row
from execution.engine.memory import SiteMemory
from execution.floor.fold import FloorWork, news_of, step_floor
from execution.floor.layouts import places_to_json
from execution.floor_protocol import (
    ResumeAsked,
    RoleFilled,
    TaskEnded,
    ToFloor,
    ToRun,
    floor_message_from_json,
    run_message_from_json,
    to_json,
)
from execution.machine.messages import CancelAsked, PauseAsked
from execution.mailbox import run_target, site_target
from execution.models import Run
from execution.reasons import SENTENCES
from execution.runs.before_start import is_admitted, may_begin
from execution.runs.facts import facts_of, things_named
from execution.runs.fold import CannotTakeIn, Facts, RunWork, fold
from execution.runs.journal import Journal
from execution.traffic import messages as m
from execution.traffic.floor_state import FloorState
from registry import services as registry
from vipo_device.kit.log_ids import bind_ids

log = logging.getLogger(__name__)
MOST_ROUNDS = 20
"""So often run and floor hear each other within a turn; who has more to say says it in the next, behind all others."""


class Turn:
    """What one turn makes of a site; nothing is written, and the memory of the site stays as it was."""

    def __init__(self, site: SiteMemory, news: News, *, look: bool) -> None:
        self.site, self.now, self.rows = site, news.now, news.rows
        self.runs: dict[str, RunWork] = {}
        self.by_hand: dict[str, ByHand] = {}
        self.floor = site.floor
        self.taken: list[int] = []
        self.kept: list[tuple[str, ToFloor | ToRun]] = []
        self.dead: list[SetAside] = []
        self.cut_off: list[Run] = []
        self.has_more = False
        self._look, self._floor_was_told = look, False
        self._for_runs: dict[str, list[Mail]] = {}
        self._for_floor: list[ToFloor] = []
        self._facts_read: set[str] = set()
        self._asked: set[tuple[str, int]] = set()
        self._devices: tuple[registry.PositionView, ...] | None = None
        self._started = [str(run) for run in news.runs]
        for row in news.rows:
            self._sort_in(row)

    def work_out(self) -> None:
        """Let everything take in what it is told, until nothing moves or everybody has had a fair share."""
        self._wake_runs()
        self._step_runs()
        self._step_floor()
        for _ in range(MOST_ROUNDS):
            if not self._for_runs and not self._for_floor:
                return
            self._step_runs()
            if self._for_floor:
                self._step_floor()
        self._keep_rest()

    @property
    def is_change(self) -> bool:
        """Tell whether there is anything to write."""
        runs = any(run.is_changed for run in self.runs.values()) or bool(self.by_hand)
        return bool(runs or self.taken or self.kept or self.dead or self.has_new_floor)

    @property
    def has_new_floor(self) -> bool:
        """Tell whether the floor is another than before, but for the time."""
        before, after = self.site.floor, self.floor
        if after is None or before is after:
            return False
        if before is None or after.commands or after.stuck or self._floor_was_told:
            return True
        return _timeless(before) != _timeless(after)

    # What is to be done

    def _sort_in(self, row: Row) -> None:
        """Read what was kept; what cannot be read is set aside."""
        kind, _, name = row.target.partition(":")
        self.taken.append(row.id)
        try:
            if kind == "run":
                self._post(name, Mail(run_message_from_json(row.payload), row.at, row.id))
            else:
                self._for_floor.append(floor_message_from_json(row.payload))
        except Exception as error:  # noqa: BLE001 - it is one message, and others wait behind it
            event = row.payload if isinstance(row.payload, dict) else {"type": "unreadable", "said": row.payload}
            self._set_aside(row.target, event, words_of(error), name if kind == "run" else "")

    def _post(self, run: str, mail: Mail) -> None:
        self._for_runs.setdefault(run, []).append(mail)

    def _wake_runs(self) -> None:
        """See to it that runs which may begin do, and that those which wait for readings look."""
        for key, work in self.site.runs.items():
            watches = self._look and work.row.watches and work.row.status == Run.Status.RUNNING
            if self._begins(work) or watches:
                self._for_runs.setdefault(key, [])
        for key, (row, error) in self.site.broken.items():
            if row.status != Run.Status.PAUSED:
                self._set_aside(run_target(key), {"type": "plan"}, error, key)

    def _begins(self, work: RunWork) -> bool:
        return work.state is None and work.row.status == Run.Status.PENDING and may_begin(work.row, self.now)

    def _keep_rest(self) -> None:
        """Keep what nobody has taken in yet for the next turn."""
        self.has_more = True
        for run, mails in self._for_runs.items():
            self.kept += [(run_target(run), mail.message) for mail in mails]
        self.kept += [(site_target(self.site.slug), message) for message in self._for_floor]
        self._for_runs, self._for_floor = {}, []

    # Runs

    def _step_runs(self) -> None:
        waiting, self._for_runs = self._for_runs, {}
        for run, mails in waiting.items():
            if run in self.site.broken and (run in self.by_hand or not self.site.mend_run(run)):
                self._refuse(run, [mail.message for mail in mails])
                continue
            work = self.runs.get(run) or self.site.runs.get(run)
            if work is not None and work.is_open:
                self._step_run(work, [*self._orders_before_start(work), *self._hold_back(work, mails)])

    def _orders_before_start(self, work: RunWork) -> list[ToRun]:
        """Return a Cancel for a run whose time has come and whose approvals have gone since it was planned.

        One of which that cannot be told is set aside, before it begins.
        """
        row = work.row
        if work.state is not None or row.not_before is None or not may_begin(row, self.now):
            return []
        try:
            return [] if is_admitted(row) else [CancelAsked(SENTENCES["approval_gone"])]
        except (DatabaseError, InterfaceError):
            raise
        except Exception as error:
            log.exception("Whether run %s may begin cannot be told.", work.id)
            self._note_dead(run_target(work.id), {"type": "start"}, words_of(error), work.id)
            return [pause_for(words_of(error))]

    def _hold_back(self, work: RunWork, mails: Sequence[Mail]) -> list[ToRun]:
        """Return what is taken in now: not the ends of tasks whose device is just about to speak, or that rest."""
        now = []
        for mail in mails:
            if held := held_for(self.site, work, mail, self._asked, self.now):
                wakes_at = time.monotonic() + held.total_seconds()
                self.site.wakes_at = min(self.site.wakes_at or wakes_at, wakes_at)
                if mail.row:
                    self.taken.remove(mail.row)
                else:
                    self.kept.append((run_target(work.id), mail.message))
            else:
                now.append(mail.message)
        return now

    def _step_run(self, work: RunWork, messages: list[ToRun]) -> None:
        """Let a run take messages in; one that raises is set aside, the run is paused in its place."""
        work = self._with_places(work)
        reading = self._facts_reader(work, messages)
        while True:  # each time round there is one thing less that may raise
            names = self.site.names_of(things_named(messages))
            try:
                new, told = fold(work, reading, messages, self.now, names)
                break
            except CannotTakeIn as bad:
                with bind_ids({"run": work.id}):
                    log.exception("Run %s cannot take something in.", work.id)
                error = words_of(bad)
                match bad.what:
                    case "facts":
                        self._note_dead(run_target(work.id), {"type": "facts"}, error, work.id)
                        reading, messages = _no_facts, [pause_for(error), *messages]
                    case int(index) if not isinstance(messages[index], PauseAsked | CancelAsked):
                        self._note_dead(run_target(work.id), to_json(messages[index]), error, work.id)
                        messages[index] = pause_for(error)
                    case _:
                        self._settle_by_hand(work, error, messages)
                        return
        self.runs[work.id] = new
        self._for_floor += told
        self._asked |= {(work.id, message.task) for message in told if isinstance(message, m.TaskAsked)}
        if self._begins(new):  # by what it was told; whether its approvals suffice is asked before that
            self._for_runs.setdefault(work.id, [])

    def _with_places(self, work: RunWork) -> RunWork:
        """Return a run that begins now with the places of its site: by these it goes, whatever becomes of them."""
        if work.state is not None or not may_begin(work.row, self.now):
            return work
        new = work.fork()
        new.row.places = places_to_json(site=self.site.slug)
        return new

    def _facts_reader(self, work: RunWork, messages: Sequence[ToRun]) -> Any:
        """Return what reads the facts for a run: once in a turn, and again when it has a robot that it had not."""
        if work.id in self._facts_read and not any(isinstance(message, RoleFilled) for message in messages):
            return _no_facts

        def read() -> Facts:
            self._facts_read.add(work.id)
            return facts_of(work.needs, work.row, messages, self.now)

        return read

    def _settle_by_hand(self, work: RunWork, error: str, messages: Sequence[ToRun]) -> None:
        """Pause a run that cannot begin, or whose machine raises whatever it is told; end it if somebody cancels it.

        One that is paused has heard none of the messages: all are set aside but orders to pause or resume.
        """
        new = work.fork()
        journal: Journal | None
        cancel = next((message for message in messages if isinstance(message, CancelAsked)), None)
        if cancel is not None:
            journal = self._cut_off(new.row, cancel)
        else:
            for message in messages:
                if not isinstance(message, PauseAsked | ResumeAsked):  # a retry resumes it, whatever it hands over
                    self._note_dead(run_target(work.id), to_json(message), error, work.id)
            self._note_dead(run_target(work.id), {"type": "start" if work.state is None else "step"}, error, work.id)
            journal = pause_by_hand(new.row, error, self.now)
        if journal is not None:
            new.lines += journal.close()
            new.is_changed = True
        self.runs[work.id] = new

    def _cut_off(self, row: Run, cancel: CancelAsked) -> Journal:
        self.cut_off.append(row)
        self._for_floor.append(m.RunOver(str(row.id)))
        return cancel_by_hand(row, cancel.reason, self.now)

    def _refuse(self, run: str, messages: Sequence[ToRun]) -> None:
        """Set aside what a run is told whose plan or state cannot be read; it can be cancelled all the same."""
        row, error = self.site.broken[run]
        hand = self.by_hand.setdefault(run, ByHand(row))
        for message in messages:
            if isinstance(message, CancelAsked) and row.status in Run.OPEN:
                hand.lines += self._cut_off(row, message).close()
            elif row.status in Run.OPEN:
                self._set_aside(run_target(run), to_json(message), error, run)

    # The floor

    def _step_floor(self) -> None:
        told, self._for_floor = self._for_floor, []
        if not told and not self._wants_look:
            return
        try:
            news = self._look_around()
            if self.floor is None:
                self.site.read_floor()
                self.floor = self.site.floor
        except registry.NoMap as error:
            self._without_map(told, error.detail)
            return
        if self.floor is None:
            self._aside_all(told, self.site.floor_error)
            return
        try:
            self._take_step(self.floor, news, told)
        except Exception as error:
            log.exception("The floor of %s cannot take something in.", self.site.slug)
            self._step_apart(news, told, words_of(error))

    @property
    def _wants_look(self) -> bool:
        """Tell whether the floor is to see where the devices are, though nobody tells it anything."""
        return self._look and (self.floor is None or self.floor.is_active)

    def _look_around(self) -> list[m.Event]:
        """Return what the registry has to tell; in a turn it is asked once, and only if what it said is old."""
        if self._devices is not None or not (self._wants_look or self._started or self.site.is_stale):
            return []
        _, self._devices = self.site.look()
        return news_of(self.floor.state, self._devices) if self.floor else []

    def _take_step(self, work: FloorWork, news: Sequence[m.Event], told: Sequence[ToFloor]) -> None:
        self._floor_was_told |= bool(told)  # then it is written, so that nobody else has changed it meanwhile
        layout = self.site.layout_for(self.runs)
        self.floor, said = step_floor(work, layout, news, told, self.now.timestamp())
        for run, message in said:
            self._post(run, Mail(message, self.now))

    def _step_apart(self, news: list[m.Event], told: Sequence[ToFloor], error: str) -> None:
        """Find out what the floor cannot take in, and set just that aside."""
        if not self._can_go_on(news, error):
            self._aside_all(told, error)
            return
        for message in told:
            assert self.floor is not None
            try:
                self._take_step(self.floor, [], [message])
            except Exception as own:  # noqa: BLE001 - it is one message, the others are taken in all the same
                run = run_of(message, self.floor.state)
                self._set_aside(site_target(self.site.slug), to_json(message), words_of(own), run)

    def _can_go_on(self, news: list[m.Event], error: str) -> bool:
        """Let the floor take in the news alone, without the tasks of one run if it has to be."""
        assert self.floor is not None
        try:
            self._take_step(self.floor, news, [])
        except Exception:  # noqa: BLE001 - then it is something that the floor has in it already
            return any(self._goes_on_without(*one, news, error) for one in without_tasks_of_one(self.floor))
        return True

    def _goes_on_without(
        self, run: str, others: FloorWork, asked: list[ToFloor], news: list[m.Event], error: str
    ) -> bool:
        """Try the floor without the tasks of a run; if that works they are set aside."""
        try:
            self._take_step(others, news, [])
        except Exception:  # noqa: BLE001 - it is not this run's tasks alone
            return False
        self._set_aside(site_target(self.site.slug), several(asked), error, run)
        return True

    def _aside_all(self, told: Sequence[ToFloor], error: str) -> None:
        """Set everything aside that a floor is told which can take in nothing at all."""
        for message in told:
            run = run_of(message, None)
            self._set_aside(site_target(self.site.slug), to_json(message), error, run)

    def _without_map(self, told: Sequence[ToFloor], why: str) -> None:
        """Let what asks for something on a floor that has no map yet fail with that reason."""
        for message in told:
            if isinstance(message, m.TaskAsked):
                self._post(message.run, Mail(TaskEnded(message.task, "failed", why), self.now))

    # What is set aside

    def _set_aside(self, target: str, event: dict[str, Any], error: str, run: str) -> None:
        """Set something aside, and pause the run that it concerns."""
        self._note_dead(target, event, error, run)
        if run in self.site.broken:
            row, _ = self.site.broken[run]
            hand = self.by_hand.setdefault(run, ByHand(row))
            journal = pause_by_hand(row, error, self.now)
            hand.lines += journal.close() if journal else []
        elif run and event.get("type") != "run_over":
            self._post(run, Mail(pause_for(error), self.now))

    def _note_dead(self, target: str, event: dict[str, Any], error: str, run: str) -> None:
        with bind_ids(log_ids_of(event, run)):
            log.warning("Something was set aside for an admin: %s", error)
        self.dead.append(
            SetAside(target, event, error, run if run in self.site.runs or run in self.site.broken else "")
        )


def _no_facts() -> Facts:
    return {}


def _timeless(work: FloorWork) -> FloorState:
    return replace(work.state, now=0.0)
