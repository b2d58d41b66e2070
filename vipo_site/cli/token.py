"""`vipo token`: the tokens by which programs ask as people, for whoever may read the database."""

from __future__ import annotations

import argparse
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from vipo_site.cli.terminal import CLEAN, complain, set_up, write, write_table

if TYPE_CHECKING:
    from registry.services import TokenView

WHAT = "Make a token by which a program asks as a member of a site, printed this once; list them, or revoke one."
SCOPES = ("read", "operate", "run", "admin", "broker")
COLUMNS = ("id", "name", "site", "person", "scopes", "until", "last used")


def add_token_arguments(sub: argparse.ArgumentParser) -> None:
    """Describe what stands behind `vipo token`."""
    actions = sub.add_subparsers(required=True, metavar="create|list|revoke")
    create = actions.add_parser("create", help="make one and print it this once")
    create.add_argument("email", help="the member as whom the program asks")
    create.add_argument("--site", required=True, help="the only site where it may ask")
    create.add_argument("--name", required=True, help="what it is for")
    may = "what it may do (read); can be said again, broker (to hear values over MQTT, too) with read alone"
    create.add_argument("--scope", action="append", choices=SCOPES, help=may)
    create.add_argument("--days", type=int, default=90, help="how long it lasts (90)")
    create.set_defaults(run=create_token)
    listed = actions.add_parser("list", help="list them, without their secrets")
    listed.add_argument("--site", default="", help="one site only")
    listed.set_defaults(run=list_tokens)
    revoke = actions.add_parser("revoke", help="end one at once")
    revoke.add_argument("id", help="its id, which is its part after vipo_")
    revoke.set_defaults(run=revoke_token)


def create_token(options: argparse.Namespace) -> int:
    """Make a token; return 0, or 2 when that cannot be."""
    set_up()
    from registry import services
    from vipo_device.protocol.errors import VipoError

    try:
        person = services.find_member(site=options.site, email=options.email)
        view, text = services.create_token(
            user=person,
            site=options.site,
            name=options.name,
            scopes=options.scope or ["read"],
            days=options.days,
            now=datetime.now(UTC),
        )
    except VipoError as error:
        return complain(error.detail)
    write(f"{view.name} asks as {view.email} at {view.site} until {view.expires_at:%Y-%m-%d}: {' '.join(view.scopes)}.")
    write(f"The token, shown this once: {text}")
    if way := services.broker_of(view=view):
        where = way["address"] or "the address that whoever runs this VIPO server knows"
        write(f"The MQTT broker: {where}, user name {way['username']}, password the token; topics {way['topics']}")
    return CLEAN


def list_tokens(options: argparse.Namespace) -> int:
    """Print the tokens; return 0, or 2 when there is no such site."""
    set_up()
    from registry import services
    from vipo_device.protocol.errors import VipoError

    try:
        sites = [services.get_site(site=options.site).slug] if options.site else services.list_slugs()
    except VipoError as error:
        return complain(error.detail)
    found = [view for site in sites for view in services.list_tokens(site=site)]
    write_table([COLUMNS, *(_row(view) for view in found)])
    return CLEAN


def _row(view: TokenView) -> tuple[str, ...]:
    used = f"{view.last_used_at:%Y-%m-%d %H:%M}" if view.last_used_at else "never"
    return view.id, view.name, view.site, view.email, " ".join(view.scopes), f"{view.expires_at:%Y-%m-%d}", used


def revoke_token(options: argparse.Namespace) -> int:
    """End a token; return 0, or 2 when there is none."""
    set_up()
    from registry import services
    from vipo_device.protocol.errors import VipoError

    try:
        view = services.revoke_token(token_id=options.id)
    except VipoError as error:
        return complain(error.detail)
    write(f"{view.name} of {view.email} at {view.site} has ended.")
    return CLEAN
