"""Calls as actions of the Web of Things: told, waited for a while, and said as an ActionStatus (WoT Profile)."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any
from uuid import UUID

from execution.commands.manual_calls import call_method, get_call
from execution.errors import ActionFailed, NotFound, TooManyWaiting
from execution.views import CallView
from registry import services as registry

MOST_WAIT_S = 20.0
LOOK_EVERY_S = 0.2
_slots = registry.Slots(in_all=40, of_site=20, of_person=5)
_PROGRESS = {"pending": "pending", "sent": "pending", "accepted": "pending", "running": "running", "done": "completed"}


def invoke_action(
    *, site: str, device_id: str, action: str, given: Mapping[str, Any], person: int, by: str
) -> CallView:
    """Send a device a command and wait a while for what comes of it; it may still be under way then.

    Raises TooManyWaiting before anything is done, what `call_method` raises, and ActionFailed.
    """
    refusal = TooManyWaiting("Too many wait for devices at once, so nothing was done. Wait until one is over.")
    with _slots.held(registry.Claim(person, site), refusal):
        call = call_method(site=site, device_id=device_id, method=action, arguments=given, by=by)
        until = time.monotonic() + MOST_WAIT_S
        while not call.is_over and time.monotonic() < until:
            time.sleep(LOOK_EVERY_S)
            call = get_call(site=site, call_id=call.id)
    if call.is_over and call.status != "done":
        raise ActionFailed(_why(call), {"call": str(call.id), "status": call.status})
    return call


def find_action(*, site: str, device_id: str, action: str, call_id: UUID) -> CallView:
    """Return a call of this action of this device. Raises NotFound."""
    call = get_call(site=site, call_id=call_id)
    if (call.device, call.method) != (device_id, action):
        raise NotFound("There is no such call at this site.")
    return call


def action_to_json(*, call: CallView, address: str) -> dict[str, Any]:
    """Return a call as an ActionStatus; `address` is where it is asked for."""
    said: dict[str, Any] = {
        "status": _PROGRESS.get(call.status, "failed"),
        "href": address,
        "timeRequested": call.created_at.isoformat(),
    }
    if call.ended_at:
        said["timeEnded"] = call.ended_at.isoformat()
    if call.status == "done":
        said["output"] = dict(call.result)
    elif call.is_over:
        said["error"] = {"type": "urn:vipo:problem:action_failed", "code": "action_failed", "detail": _why(call)}
    return said


def _why(call: CallView) -> str:
    return call.why or f"{call.device} did not do {call.method}: {call.status}."
