"""What is wrong at a site: with VIPO's processes, with the site's archive, and what was set aside there."""

from __future__ import annotations

from execution.models import DeadLetter
from execution.retention.periods import count_in_trouble, get_keeping
from registry import services as registry

_WAITS_FOR_ADMINS = DeadLetter.State.OPEN


def find_trouble_at(*, site: str) -> tuple[registry.Finding, ...]:
    """Return what is wrong with the processes and with this site, the gravest first."""
    found = [*registry.find_trouble(processes=registry.list_processes())]
    if count := DeadLetter.objects.filter(site__slug=site, state=_WAITS_FOR_ADMINS).count():
        found.append(_set_aside(count))
    if why := get_keeping(site=site).trouble:
        found.append(_archive_failed(why))
    return tuple(sorted(found, key=lambda finding: finding.severity != "error"))


def find_trouble_of_sites() -> tuple[registry.Finding, ...]:
    """Return what is wrong with sites and not with processes: one finding for each site, with two questions in all."""
    waiting = DeadLetter.objects.filter(state=_WAITS_FOR_ADMINS).values("site").distinct().count()
    return (_set_aside(1),) * waiting + (_archive_failed(""),) * count_in_trouble()


def _set_aside(count: int) -> registry.Finding:
    return registry.Finding("set_aside", "error", {"count": count})


def _archive_failed(why: str) -> registry.Finding:
    return registry.Finding("archive_failed", "warning", {"why": why})
