"""Make a database with two sites and a person for each role; prints what the tests need as JSON."""

import json
import os
import sys
from typing import Any

import django

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
    from django.core.management import call_command

    from editor import services as editor
    from registry import services as registry

    call_command("migrate", verbosity=0, interactive=False)
    registry.create_site(name="Hall", slug="hall")
    registry.create_site(name="Elsewhere", slug="elsewhere")
    sessions = {name: make_person(name, "hall", role) for name, role in ROLES.items()}
    sessions["stranger"] = make_person("stranger", "elsewhere", "admin")
    return {"sessions": sessions, "program": str(editor.create_program(site="hall", name="Shared").id)}


if __name__ == "__main__":
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "tests.settings")
    django.setup()
    sys.stdout.write(json.dumps(prepare()))
