"""Rehearsals as rows: queued by a person, cancelled by them or an operator, watched in the browser.

Which one is next, and how many a person or a site may have, is decided on rows under one lock; the queue of Celery has
hints only. `worker` carries them out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime, timedelta
from typing import Any, Literal
from uuid import UUID

from django.conf import settings
from django.db import transaction
from django.db.models import Max, QuerySet
from django.db.models.functions import Now

from editor import services as editor
from execution import mailbox
from execution.archive.rows import read_rehearsal
from execution.errors import NotFound, NotPossibleNow, TooManyRehearsals
from execution.floor.layouts import find_bodies, place_facts
from execution.mirror.calibrations import find_paces
from execution.models import Lease, Rehearsal
from execution.rehearsals.beginnings import beginning_readings
from execution.rehearsals.child_process import scene_to_json
from execution.rehearsals.queue_order import Entry, order_fairly
from execution.rehearsals.recording_file import write_json, write_mcap
from execution.rehearsals.views import RehearsalView, view_rehearsal
from execution.runs.programs import Prepared
from execution.traffic.messages import zone_to_json
from registry import services as registry
from simulation.fault_form import check_faults, read_faults
from simulation.world import DELIVERY_S, Scene

QUEUE = "rehearsals"
RUNNING = Rehearsal.Status.RUNNING
REMEMBERED = timedelta(hours=1)
"""How long it counts, among equals, that somebody's rehearsal was begun."""
RecordingForm = Literal["json", "mcap"]
HEAVY = ("job", "document", "compiled", "result")


def start_rehearsal(
    *, prepared: Prepared, by: str, person: int | None = None, seed: int = 0, driver: str = "physics",
    faults: Mapping[str, Any] | None = None,
) -> RehearsalView:  # fmt: skip
    """Queue a rehearsal of a program that was checked, in the site as it stands now; `person` is whose it is.

    `faults` go wrong in it on purpose (`simulation.fault_form`); they reach the child that rehearses and nobody else.

    Raises:
        TooManyRehearsals: the person or the site has as many as may wait or be under way.
        BadFaults: they are not understood, or are of a device, reading or step that there is not.
    """
    refuse_too_many(site=prepared.site, person=person)  # before the scene is made: who asks too often costs little
    devices = registry.list_devices(site=prepared.site, lifecycle="approved")
    scene = _scene(prepared, devices, seed, faults)
    given = {"driver": driver, "parameters": dict(prepared.parameters)}
    row = put_into_queue(
        site=prepared.site, person=person, program=prepared.program, program_name=prepared.name,
        job={"plan": prepared.plan, "scene": scene, "bodies": _bodies(devices), **given},
        asked={
            "version": prepared.version, "seed": seed, **given, "faults": scene["faults"]["faults"],
            "paces": scene["paces"],
        },
        document=prepared.document, compiled=prepared.compiled, started_by=by,
    )  # fmt: skip
    return view_rehearsal(row, order_of_queue())


def put_into_queue(*, site: str, person: int | None, **columns: Any) -> Rehearsal:
    """Add a rehearsal, or tests, to the queue. Raises TooManyRehearsals."""
    with transaction.atomic():
        lock_queue()
        refuse_too_many(site=site, person=person)
        site_id = registry.get_site_id(site=site)
        row = Rehearsal.objects.create(site_id=site_id, person=person, created_at=datetime.now(UTC), **columns)
    transaction.on_commit(lambda: mailbox.send_hint(mailbox.REHEARSE, str(row.id)))
    return row


def refuse_too_many(*, site: str, person: int | None) -> None:
    """Refuse what is more than a person or a site may have waiting or under way. Raises TooManyRehearsals."""
    under_way = Rehearsal.objects.filter(status__in=Rehearsal.OPEN)
    of_person = under_way.filter(person=person).count() if person is not None else 0
    most = settings.VIPO_REHEARSALS_OF_PERSON
    if of_person >= most:
        raise TooManyRehearsals(
            f"{of_person} rehearsals of yours wait or are under way; you may have {most} at a time. "
            "Wait until one is over, or cancel one.",
            {"why": "person", "number": of_person, "most": most},
        )
    of_site, most = under_way.filter(site__slug=site).count(), settings.VIPO_REHEARSALS_OF_SITE
    if of_site >= most:
        raise TooManyRehearsals(
            f"{of_site} rehearsals of this site wait or are under way; it may have {most} at a time. "
            "Wait until one is over, or ask who has several to cancel one.",
            {"why": "site", "number": of_site, "most": most},
        )


def lock_queue() -> None:
    """Let no other process take from the queue or add to it until this transaction is over."""
    Lease.objects.get_or_create(name=QUEUE, defaults={"holder": "", "until": datetime.now(UTC)})
    Lease.objects.select_for_update().get(name=QUEUE)


def order_of_queue() -> tuple[UUID, ...]:
    """Return those that wait, of all sites, in the order in which they will be taken as things stand."""
    rows = Rehearsal.objects.filter(status__in=Rehearsal.OPEN)
    found = rows.only("site_id", "person", "created_at", "status")
    recent = Rehearsal.objects.filter(began_at__gt=Now() - REMEMBERED)
    begun = recent.values_list("site_id", "person").annotate(at=Max("began_at"))
    return order_fairly(
        [Entry(row.id, row.site_id, row.person, row.created_at, row.status == RUNNING) for row in found],
        {(site, person): at for site, person, at in begun},
    )


def _bodies(devices: Sequence[registry.DeviceView]) -> list[dict[str, Any]]:
    """Return where real robots stand that are simulated for a while: there a run lets nobody drive either."""
    return [zone_to_json(body) for body in find_bodies((device, device.canonical) for device in devices)]


def _scene(
    prepared: Prepared, devices: Sequence[registry.DeviceView], seed: int, faults: Mapping[str, Any] | None
) -> dict[str, Any]:
    """Return the site as it stands: its approved devices where they are, with what they hold and what they show.

    Simulated sources and sinks are seen to as the twin does, once they are empty or full; nobody knows of the others.
    """
    site = prepared.site
    places = [place_facts(place) for place in registry.list_places(site=site)]
    robots = {d.id: d for d in devices if d.kind == "robot"}
    scene = Scene(
        grid=registry.get_map(site=site, to_plan=True).grid,
        devices=[d.at_home for d in devices],
        seed=seed,
        faults=() if faults is None else read_faults(faults),
        poses={name: robot.pose for name, robot in robots.items()},
        carrying={name: robot.carrying for name, robot in robots.items()},
        readings={d.id: begin for d in devices if (begin := beginning_readings(d))},
        delivery_s=DELIVERY_S,
        delivered=frozenset(d.id for d in devices if d.kind == "machine" and d.played.simulated),
        paces=find_paces(site=site),
        idless=frozenset(d.id for d in devices if d.only_done_flag),
    )
    check_faults(scene.faults, scene.devices, _steps(prepared.plan))
    return scene_to_json(scene, places, editor.find_zones(site=site))


def _steps(plan: Mapping[str, Any]) -> set[str]:
    return {step for i in plan["instructions"] for step in (i["step"], *i.get("enters", ()))}


def get_rehearsal(*, rehearsal_id: UUID | str) -> RehearsalView:
    """Return a rehearsal, from the archive if it is there.

    Raises:
        NotFound: there is none.
        HistoryUnreadable: it is in the archive, which cannot be read.
    """
    row = _find(Rehearsal.objects.select_related("archive").defer("job"), rehearsal_id)
    return _view(read_rehearsal(row) if row.archive_id else row)


def export_rehearsal(*, rehearsal_id: UUID | str, form: RecordingForm) -> bytes:
    """Return a rehearsal with its recording as a file.

    Raises:
        NotFound: there is none.
        NotPossibleNow: it has no result yet, or came to none.
        HistoryUnreadable: it is in the archive, which cannot be read.
    """
    view = get_rehearsal(rehearsal_id=rehearsal_id)
    if view.kind == Rehearsal.Kind.TESTS:
        raise NotPossibleNow("Tests of a program have no recording. Rehearse the program; a rehearsal has one.")
    if view.result is None:
        raise NotPossibleNow(f"The rehearsal has no recording: it is {view.status}. One that is done has one.")
    return write_json(view) if form == "json" else write_mcap(view)


def list_open_rehearsals(*, site: str) -> list[RehearsalView]:
    """Return the site's rehearsals that are under way, and then those that wait, in their order; without documents."""
    rows = Rehearsal.objects.filter(site__slug=site, status__in=Rehearsal.OPEN).select_related("site").defer(*HEAVY)
    order = order_of_queue()
    places = {rehearsal: place for place, rehearsal in enumerate(order, 1)}
    return [
        view_rehearsal(row, order, whole=False)
        for row in sorted(rows, key=lambda row: (places.get(row.id, 0), row.created_at))
    ]


def cancel_rehearsal(*, rehearsal_id: UUID | str, by: str) -> RehearsalView:
    """End a rehearsal that waits or is under way; the worker that has it notices within a second.

    Raises:
        NotFound: there is none.
        NotPossibleNow: it is over. One that was cancelled already stays as it is.
    """
    still_open = Rehearsal.objects.filter(id=rehearsal_id, status__in=Rehearsal.OPEN)
    cancelled = still_open.update(
        status=Rehearsal.Status.CANCELLED, reason=f"{by} cancelled the rehearsal.", ended_at=Now(), claim=None
    )
    row = _find(Rehearsal.objects.defer(*HEAVY), rehearsal_id)
    if cancelled:
        publish_rehearsal(row)
    elif row.status != Rehearsal.Status.CANCELLED:
        raise NotPossibleNow("The rehearsal is over already.", {"why": "rehearsal_over"})
    return _view(row, whole=False)


def _find(rows: QuerySet[Rehearsal], rehearsal_id: UUID | str) -> Rehearsal:
    row = rows.select_related("site").filter(id=rehearsal_id).first()
    if row is None:
        raise NotFound("There is no such rehearsal. It may have been deleted with its program.")
    return row


def _view(row: Rehearsal, *, whole: bool = True) -> RehearsalView:
    return view_rehearsal(row, order_of_queue() if row.status == Rehearsal.Status.QUEUED else (), whole=whole)


def publish_rehearsal(row: Rehearsal) -> None:
    """Tell the site's screens how a rehearsal stands."""
    message = {
        "type": "rehearsal", "id": str(row.id), "status": row.status, "progress": row.progress,
        "course": row.course or None, "tries": row.tries, "kind": row.kind, "program": str(row.program),
    }  # fmt: skip
    registry.publish(row.site.slug, message)
    if row.kind == Rehearsal.Kind.TESTS and not (row.status == RUNNING and row.course):
        registry.publish(row.site.slug, {"type": "tests", "program": str(row.program)})
