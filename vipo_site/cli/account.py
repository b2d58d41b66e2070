"""`vipo account`: who may sign in, a person or a program, and what they may do at a site."""

from __future__ import annotations

import argparse

from vipo_site.cli.terminal import CLEAN, complain, set_up, write

ACCOUNT = "Let somebody sign in, or a program, and give them a role at a site; a new password is printed this once."
NOTHING = "Name what to change: --site with --role, --sites, or --new-password."
ROLES = ("viewer", "commenter", "operator", "author", "admin", "none")


def add_account_arguments(sub: argparse.ArgumentParser) -> None:
    """Describe what stands behind `vipo account`."""
    sub.add_argument("email", help="the e-mail address to sign in with; nothing is sent to it")
    sub.add_argument("--name", default="", help="how others see them (a new account: what stands before the @)")
    sub.add_argument("--site", default="", help="make them a member of this site")
    sub.add_argument("--role", choices=ROLES, default="viewer", help="what they may do there (viewer); none: no more")
    sub.add_argument("--sites", type=int, help="how many sites they may make in all (0: none)")
    ending = sub.add_mutually_exclusive_group()
    ending.add_argument("--new-password", action="store_true", help="another password; who is signed in is signed out")
    ending.add_argument("--close", action="store_true", help="they are signed out and sign in no more; work stays")
    ending.add_argument("--reopen", action="store_true", help="they may sign in again, with a new password")
    sub.add_argument("--no-second-factor", action="store_true", help="take it away: who lost theirs is signed out")
    sub.set_defaults(run=set_account)


def set_account(options: argparse.Namespace) -> int:
    """Make or change an account; return 0, or 2 when that cannot be and nothing was changed."""
    set_up()
    from django.db import transaction

    from vipo_device.protocol.errors import VipoError

    try:
        with transaction.atomic():
            told = _decide(options)
    except VipoError as error:
        return complain(error.detail)
    for line in told:
        write(line)
    return CLEAN


def _decide(options: argparse.Namespace) -> list[str]:
    """Do what was asked for and return what to say of it. Raises VipoError."""
    from registry import services

    email: str = options.email.strip().lower()
    told, password = [], services.draw_password(email=email, display_name=options.name or email.partition("@")[0])
    if options.close:
        services.close_account(email=email)
        return [f"{email} signs in no more. --reopen undoes that."]
    if options.reopen:
        services.reopen_account(email=email, password=password)
        told = [f"{email} may sign in again.", f"The password, shown this once: {password}"]
    elif not services.is_known(email=email):
        services.create_user(email=email, password=password, display_name=options.name or email.partition("@")[0])
        told = [f"{email} may sign in.", f"The password, shown this once: {password}"]
    elif options.new_password:
        services.change_password(email=email, password=password)
        told = [f"The new password of {email}, shown this once: {password}"]
    if options.no_second_factor:
        services.reset_factor(user=services.find_person(email=email))
        told.append(f"{email} has no second factor any more.")
    if options.sites is not None:
        services.set_site_quota(email=email, sites=options.sites)
        told.append(f"{email} may make {options.sites} sites in all.")
    if options.site and options.role == "none":
        services.get_site(site=options.site)
        services.remove_member(site=options.site, email=email)
        told.append(f"{email} is no member of {options.site}.")
    elif options.site:
        services.set_member(site=options.site, email=email, role=options.role)
        told.append(f"{email} is {options.role} of {options.site}.")
    return told or [f"{email} may sign in already. {NOTHING}"]
