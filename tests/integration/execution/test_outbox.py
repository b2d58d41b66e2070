"""The order in which commands leave, also when a gateway dies between claiming and sending."""

from datetime import UTC, datetime, timedelta
from uuid import uuid4

from execution import services
from execution.models import Command
from registry.models import Site


def add(site, position, device="robot01", method="move", *, piece=True):
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
