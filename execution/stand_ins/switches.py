"""Switching a device to its stand-in and back, where nobody uses it.

The floor's row is locked meanwhile and gets another epoch: what its owner has decided by then is decided anew, so that
each command is for the one that counts when it is written.
"""

from __future__ import annotations

from typing import Any

from django.db import transaction
from django.db.models import F

from execution import database, mailbox
from execution.commands.manual_calls import check_unused
from execution.errors import NotPossibleNow
from execution.models import FloorState
from registry import services as registry


def simulate_device(*, site: str, device_id: str, simulated: bool, by: Any) -> registry.DeviceView:
    """Let a stand-in do from now on what a device is told, or the device itself again.

    Raises:
        NoSuchDevice: the site has no such device.
        NotPossibleNow: a run holds the device, it carries something out, or it is not approved.
    """
    device = registry.get_device(site=site, device_id=device_id)
    with transaction.atomic():
        FloorState.objects.get_or_create(site_id=registry.get_site_id(site=site))
        row = FloorState.objects.select_for_update(of=("self",)).get(site__slug=site)
        device = registry.get_device(site=site, device_id=device_id)
        if device.stand_in == simulated:
            return device
        if device.lifecycle != "approved":
            raise NotPossibleNow(f"{device.name} waits for approval. An admin of the site can approve it.")
        check_unused(row, device)
        at = database.now()
        switched = registry.switch_stand_in(site=site, device_id=device_id, simulated=simulated, by=by, at=at)
        FloorState.objects.filter(pk=row.pk).update(epoch=F("epoch") + 1)
        transaction.on_commit(lambda: mailbox.say_changed(site))
    return switched
