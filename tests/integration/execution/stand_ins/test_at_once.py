"""Somebody switches a device while somebody else uses it, in two sessions of one PostgreSQL."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from django.db import transaction
from pytest_django import DjangoDbBlocker

from execution import services
from execution.errors import NotPossibleNow
from execution.models import Command, FloorState
from execution.stand_ins.switches import simulate_device
from registry import services as registry
from registry.models import AuditLine, Device, Site
from tests.kit import demo_floor
from tests.kit.databases import Aside, on_database, one_waits
from tests.kit.programs import SITE
from tests.kit.waiting import wait_for
from vipo_device.protocol.description import description_to_json
from vipo_site.settings import postgres

pytestmark = pytest.mark.servers
MIXER = "paintMixer01"


@pytest.fixture
def hall(database_url: str, django_db_blocker: DjangoDbBlocker) -> Iterator[None]:
    """A site with a mixer, on a PostgreSQL."""
    with django_db_blocker.unblock(), on_database(**postgres(database_url)):
        registry.create_site(name="Painting Factory", slug=SITE)
        described = next(description_to_json(device) for device in demo_floor.devices() if device.id == MIXER)
        site = Site.objects.get(slug=SITE)
        Device.objects.create(id=MIXER, site=site, lifecycle="approved", description=described, online=True)
        yield


def switch(*, simulated: bool = True) -> registry.DeviceView:
    return simulate_device(site=SITE, device_id=MIXER, simulated=simulated, by=None)


def call() -> Any:
    return services.call_method(site=SITE, device_id=MIXER, method="mixPaint", arguments={"time": 1}, by="Ada")


def test_a_call_that_waited_for_a_switch_is_for_the_one_that_counts_then(hall: None, aside: Aside) -> None:
    with transaction.atomic():
        switch()
        Device.objects.filter(pk=MIXER).update(online=True)  # its stand-in is there
        later = aside(call)
        wait_for("the call", one_waits)
    made = later.result(20)
    assert Command.objects.get(pk=made.id).stand_in


def test_a_switch_that_waited_for_a_call_is_refused(hall: None, aside: Aside) -> None:
    with transaction.atomic():
        made = call()
        later = aside(switch)
        wait_for("the switch", one_waits)
    with pytest.raises(NotPossibleNow, match="still carries out mixPaint"):
        later.result(20)
    assert not Command.objects.get(pk=made.id).stand_in
    assert not Device.objects.get(pk=MIXER).stand_in


def test_four_who_switch_at_once_switch_once(hall: None, aside: Aside) -> None:
    assert all(each.result(20).stand_in for each in [aside(switch) for _ in range(4)])
    assert FloorState.objects.get(site__slug=SITE).epoch == 1
    assert AuditLine.objects.filter(code="device_simulated").count() == 1
