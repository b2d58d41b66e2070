"""The real ASGI application in Daphne, as the product starts it, and the site that its tests have.

-m tests.kit.web_process prepare      makes two sites and people in a migrated database, prints them as JSON
-m tests.kit.web_process people ROLE COUNT      makes so many more people of the first site, prints their sessions
-m tests.kit.web_process PORT         serves
"""

from __future__ import annotations

import json
import os
import sys
from typing import Any

import django
from daphne.server import Server

from vipo_site.http import MOST_MESSAGE_BYTES

ROLES = {"viewer": "viewer", "operator": "operator", "author": "author", "admin": "admin", "second": "author"}


def make_session(user: Any) -> str:
    from django.conf import settings
    from django.contrib.auth import BACKEND_SESSION_KEY, HASH_SESSION_KEY, SESSION_KEY
    from django.contrib.sessions.backends.db import SessionStore

    session = SessionStore()
    session[SESSION_KEY] = str(user.pk)
    session[BACKEND_SESSION_KEY] = settings.AUTHENTICATION_BACKENDS[0]
    session[HASH_SESSION_KEY] = user.get_session_auth_hash()
    session.save()
    return str(session.session_key)


def make_person(name: str, site: str, role: str) -> str:
    from registry import services as registry

    user = registry.create_user(email=f"{name}@vipo.example", password="a long password", display_name=f"Ada {name}")
    registry.set_member(site=site, email=user.email, role=role)
    return make_session(user)


def prepare() -> dict[str, Any]:
    from editor import services as editor
    from registry import services as registry

    registry.create_site(name="Hall", slug="hall")
    registry.create_site(name="Elsewhere", slug="elsewhere")
    sessions = {name: make_person(name, "hall", role) for name, role in ROLES.items()}
    sessions["stranger"] = make_person("stranger", "elsewhere", "admin")
    return {"sessions": sessions, "program": str(editor.create_program(site="hall", name="Shared").id)}


def make_people(role: str, count: int) -> list[str]:
    return [make_person(f"{role}{number}", "hall", role) for number in range(count)]


def serve(port: str) -> None:
    from vipo_site.asgi import application

    Server(
        application,
        endpoints=[f"tcp:port={port}:interface=127.0.0.1"],
        websocket_max_message_size=MOST_MESSAGE_BYTES,
        websocket_max_frame_size=MOST_MESSAGE_BYTES,
        application_close_timeout=2,
        verbosity=0,
    ).run()


if __name__ == "__main__":
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "tests.settings")
    if sys.argv[1] == "prepare":
        django.setup()
        sys.stdout.write(json.dumps(prepare()))
    elif sys.argv[1] == "people":
        django.setup()
        sys.stdout.write(json.dumps(make_people(sys.argv[2], int(sys.argv[3]))))
    else:
        serve(sys.argv[1])
