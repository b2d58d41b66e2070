"""Change a person's role at the hall in the server's database and tell the server: set_role.py PERSON ROLE."""

import os
import sys

import django

if __name__ == "__main__":
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "tests.settings")
    django.setup()
    from registry import services as registry

    person, role = sys.argv[1:]
    if role == "none":
        registry.remove_member(site="hall", email=f"{person}@vipo.example")
    else:
        registry.set_member(site="hall", email=f"{person}@vipo.example", role=role)
