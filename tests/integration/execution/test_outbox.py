"""The order in which commands leave, also when a gateway dies between claiming and sending."""

import logging
from datetime import UTC, datetime, timedelta
from uuid import UUID, uuid4

from execution import services
from execution.commands.claim import mark_sent
from execution.commands.outbox import Answer, record_acks
from execution.models import Command, InboxEvent, SiteStop
from registry.models import Site
from vipo_device.kit.log_ids import bound_ids


def add(site, position, device="robot01", method="move", *, piece=True, **more):
    now = datetime.now(UTC) - timedelta(seconds=1)
    row = Command.objects.create(
        id=uuid4(),
        site=site,
        position=position,
        device=device,
        method=method,
        piece=piece,
        send_after=now,
        created_at=now,
        **more,
    )
    return str(row.id)


def claimed():
    return [command.id for command in services.claim_commands(limit=10)]


def accept(device, command):
    now = datetime.now(UTC)
    return services.record_ack(device=device, command_id=command, status="ACCEPTED", why="", result={}, at=now)


def test_a_piece_of_way_waits_until_the_one_before_it_is_accepted(db):
    site = Site.objects.create(name="Hall", slug="hall")
    first, second, other = add(site, 1), add(site, 2), add(site, 3, "robot02")
    call = add(site, 4, "oven", "curePaint", piece=False)
    assert claimed() == [first, other, call]
    assert claimed() == []
    assert accept("robot01", first)
    assert claimed() == [second]


def test_a_gateway_that_died_with_a_piece_does_not_let_the_next_one_overtake_it(db):
    site = Site.objects.create(name="Hall", slug="hall")
    first, second = add(site, 1), add(site, 2)
    assert claimed() == [first]
    Command.objects.filter(id=first).update(send_after=datetime.now(UTC))
    assert claimed() == [first]
    assert accept("robot01", first)
    assert claimed() == [second]


def answer(device, command, status):
    now = datetime.now(UTC)
    return services.record_ack(device=device, command_id=command, status=status, why="", result={}, at=now)


def test_who_has_driven_a_piece_has_driven_those_before_it_even_when_that_was_not_heard(db):
    site = Site.objects.create(name="Hall", slug="hall")
    pieces = [add(site, position) for position in (1, 2, 3)]
    pick = add(site, 4, method="pick", piece=False)
    for piece in pieces:
        claimed()
        accept("robot01", piece)
    assert answer("robot01", pieces[1], "DONE")
    statuses = dict(Command.objects.values_list("id", "status"))
    assert [statuses[UUID(piece)] for piece in pieces] == ["done", "done", "accepted"]
    assert statuses[UUID(pick)] == "pending"


def test_nothing_new_goes_out_so_far_behind_an_open_command_that_the_device_might_do_it_again(db):
    site = Site.objects.create(name="Hall", slug="hall")
    open_one = add(site, 1, method="greet", piece=False)
    others = [add(site, position, method="wave", piece=False) for position in range(2, 16)]
    cancel = add(site, 16, method="cancel", piece=False)
    elsewhere = add(site, 17, "oven", "curePaint", piece=False)
    sent = [command.id for command in services.claim_commands(limit=100)]
    assert sent == [open_one, *others[:11], cancel, elsewhere]
    for command in others[:11]:
        answer("robot01", command, "DONE")
    assert claimed() == []
    answer("robot01", open_one, "DONE")
    assert claimed() == others[11:]


def test_claiming_asks_twice_and_takes_once_whatever_waits(db, django_assert_num_queries):
    site = Site.objects.create(name="Hall", slug="hall")
    first = add(site, 1)
    calls = [add(site, position, f"oven{position}", "curePaint", piece=False) for position in range(2, 6)]
    with django_assert_num_queries(3):
        assert claimed() == [first, *calls]
    with django_assert_num_queries(1):
        assert claimed() == []


def test_a_stopped_site_gets_controls_only_and_another_one_everything(db):
    hall, yard = Site.objects.create(name="Hall", slug="hall"), Site.objects.create(name="Yard", slug="yard")
    SiteStop.objects.create(site=hall, active=True)
    SiteStop.objects.create(site=yard, active=False)
    held, pause, free = add(hall, 1), add(hall, 2, method="pause", piece=False), add(yard, 1, "robot09")
    assert claimed() == [pause, free]
    SiteStop.objects.update(active=False)
    assert claimed() == [held]


def test_who_does_not_answer_is_asked_again_after_2_4_8_and_then_every_15_seconds(db):
    site = Site.objects.create(name="Hall", slug="hall")
    command, waits = add(site, 1), []
    for _ in range(5):
        Command.objects.update(send_after=datetime.now(UTC))
        begun = datetime.now(UTC)
        assert claimed() == [command]
        row = Command.objects.get()
        waits.append(int((row.send_after - begun).total_seconds()))
    assert (waits, row.tries) == ([2, 4, 8, 15, 15], 5)


def test_what_was_accepted_is_asked_for_again_after_5_10_and_then_every_15_seconds(db):
    site = Site.objects.create(name="Hall", slug="hall")
    command, waits = add(site, 1, "oven", "heat", piece=False), []

    def note_wait(since):
        waits.append(round((Command.objects.get().send_after - since).total_seconds()))

    for status in ("ACCEPTED", "RUNNING", "RUNNING", "RUNNING"):
        begun = datetime.now(UTC)
        Command.objects.update(send_after=begun)
        assert claimed() == [command]
        note_wait(begun)
        begun = datetime.now(UTC)
        assert answer("oven", command, status)
        note_wait(begun)
    assert waits == [2, 5, 10, 10, 15, 15, 15, 15]


def test_what_a_device_fails_at_is_a_line_of_the_log_with_run_step_and_command(db):
    site = Site.objects.create(name="Hall", slug="hall")
    run = uuid4()
    done, failed = (add(site, place, "oven", "heat", piece=False, run=run, step=f"s{place}") for place in (1, 2))
    lines, handler = [], logging.Handler()
    handler.emit = lambda record: lines.append((record.getMessage(), dict(bound_ids())))
    log = logging.getLogger("execution.commands.outbox")
    log.addHandler(handler)
    log.setLevel(logging.INFO)
    try:
        for command, status in ((done, "DONE"), (failed, "FAILED")):
            claimed()
            assert answer("oven", command, status)
    finally:
        log.removeHandler(handler)
        log.setLevel(logging.NOTSET)
    ids = {"site": "hall", "run": str(run), "step": "s2", "command": failed, "device": "oven"}
    assert lines == [("oven did not do heat (failed): it says no more", ids)]
    assert dict(bound_ids()) == {}


def said(device, command, status="DONE"):
    return Answer(device, command, status, "", {})


def test_answers_of_many_devices_are_one_transaction_and_each_counts_once(db, django_assert_max_num_queries):
    site = Site.objects.create(name="Hall", slug="hall")
    ids = [add(site, position, f"oven{position}", "heat", piece=False) for position in range(50)]
    answers = [said(f"oven{position}", command) for position, command in enumerate(ids)]
    now = datetime.now(UTC)
    with django_assert_max_num_queries(9):  # fifty rows go with four statements
        assert record_acks(answers=answers, at=now) == [True] * 50
    assert set(Command.objects.values_list("status", "ended_at")) == {("done", now)}
    assert sorted(InboxEvent.objects.values_list("key", flat=True)) == sorted(f"answer:{command}" for command in ids)
    assert record_acks(answers=answers, at=now) == [False] * 50
    assert InboxEvent.objects.count() == 50


def test_a_device_that_answers_for_another_in_the_same_moment_changes_nothing(db):
    site = Site.objects.create(name="Hall", slug="hall")
    mine, other = add(site, 1, "oven", "heat", piece=False), add(site, 2, "mixer", "mix", piece=False)
    answers = [
        said("oven", mine), said("mixer", mine, "FAILED"), said("mixer", other, "ACCEPTED"), said("press", "nonsense"),
        said("press", str(uuid4())), said("mixer", other, "DANCING"),
    ]  # fmt: skip
    now = datetime.now(UTC)
    assert record_acks(answers=answers, at=now) == [True, False, True, False, False, False]
    assert dict(Command.objects.values_list("id", "status")) == {UUID(mine): "done", UUID(other): "accepted"}
    assert record_acks(answers=[said("press", "nonsense")], at=now) == [False]


def test_what_is_answered_before_it_is_marked_as_sent_knows_when_it_went_out_and_the_mark_comes_too_late(db):
    site = Site.objects.create(name="Hall", slug="hall")
    quick, slow = add(site, 1, "oven", "heat", piece=False), add(site, 2, "mixer", "mix", piece=False)
    before = datetime.now(UTC)
    assert claimed() == [quick, slow]
    later = datetime.now(UTC) + timedelta(seconds=1)
    assert record_acks(answers=[said("oven", quick)], at=later) == [True]
    sent_at = Command.objects.get(id=quick).sent_at
    assert before - timedelta(seconds=0.1) <= sent_at < later
    mark_sent(sent=dict.fromkeys([quick, slow], later))
    rows = {str(row.id): (row.status, row.sent_at) for row in Command.objects.all()}
    assert rows == {quick: ("done", sent_at), slow: ("sent", later)}
