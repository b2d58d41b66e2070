"""Another map for a site that is already at work: only while nothing is under way, and the floor begins anew on it."""

from __future__ import annotations

from collections.abc import Callable
from uuid import uuid4

from django.db import transaction

from execution import mailbox
from execution.errors import NotPossibleNow
from execution.floor.stops import is_stopped
from execution.models import Command, FloorState, Run
from execution.traffic.messages import StopPressed
from registry import services as registry


def change_map(*, site: str, change: Callable[[], registry.MapView]) -> registry.MapView:
    """Carry out a change of the site's map, and let traffic begin anew on it.

    Raises:
        NotPossibleNow: a run is open, or a device still carries out a command.
    """
    with transaction.atomic():
        FloorState.objects.get_or_create(site_id=registry.get_site_id(site=site))
        floor = FloorState.objects.select_for_update(of=("self",)).get(site__slug=site)
        _require_rest(site)
        changed = change()
        _begin_anew(floor, site)
    return changed


def _require_rest(site: str) -> None:
    runs = Run.objects.filter(site__slug=site, status__in=Run.OPEN).order_by("number").values_list("number", flat=True)
    if runs:
        named = ", ".join(map(str, runs[:5]))
        raise NotPossibleNow(
            f"The map cannot change under a run. Wait until these are over, or cancel them: {named}.",
            {"why": "map_runs", "runs": named, "count": len(runs)},
        )
    busy = Command.objects.filter(site__slug=site, status__in=Command.OPEN).values_list("device", flat=True).first()
    if busy is not None:
        raise NotPossibleNow(
            f"{busy} still carries out a command. Wait until it is done, or cancel it.",
            {"why": "map_busy", "device": busy},
        )


def _begin_anew(floor: FloorState, site: str) -> None:
    """Forget the old map's cells; commands get ids of a new namespace, and a stop goes on."""
    floor.state, floor.namespace = None, uuid4()
    floor.epoch += 1  # the owner that knows the old floor writes nothing any more
    floor.save(update_fields=["state", "namespace", "epoch"])
    if is_stopped(site=site):
        mailbox.post_to_floor(site, [(f"stop:{uuid4()}", StopPressed())])
    mailbox.hint(site)
