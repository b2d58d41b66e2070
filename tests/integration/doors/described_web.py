"""The site that Schemathesis asks, and the process that serves it, in which nobody waits for a device or a broker.

-m tests.integration.doors.described_web prepare NAME…   makes the site, prints as JSON what is there, with a person of
                                                         each role for each of the names, and their sessions
-m tests.integration.doors.described_web PORT            serves
"""

from __future__ import annotations

import json
import sys
from typing import Any

import django

ROLES = ("viewer", "admin")


def prepare(names: list[str]) -> dict[str, Any]:
    from registry.models import Membership, Site, User
    from tests.kit.api_calls import make_one_of_each
    from tests.kit.sites import make_hall
    from tests.kit.web_process import make_session

    site = Site.objects.get(slug=make_hall())
    known = make_one_of_each(site.slug)
    sessions = {}
    for role in ROLES:
        for name in names:
            # Of a person each, so that no call bears upon another: signing out, a limit of what one person may do.
            user = User.objects.create(
                email=f"{name}.{role}@vipo.example", password="!", display_name=f"{name} {role}", site_quota=2
            )
            Membership.objects.create(user=user, site=site, role=role)
            sessions[f"{name} {role}"] = make_session(user)
    return {"known": known, "sessions": sessions}


def serve(port: str) -> None:
    from django.conf import settings

    from execution.commands import invocations
    from registry.thing_directory import property_values
    from tests.kit import web_process

    settings.VIPO_BROKER_ACCOUNTS = "registry.broker.accounts.AskedAccounts"
    property_values.MOST_POLL_S = 0.0
    invocations.MOST_WAIT_S = 0.1
    web_process.serve(port)


if __name__ == "__main__":
    django.setup()
    if sys.argv[1] == "prepare":
        sys.stdout.write(json.dumps(prepare(sys.argv[2:])))
    else:
        serve(sys.argv[1])
