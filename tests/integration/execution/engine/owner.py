"""An owner of a site in a process of its own; its arguments: the site, how long it stays, and how long it lingers."""

import sys

import django

django.setup()

from execution.engine.drive import drive_site  # noqa: E402

print(drive_site(sys.argv[1], stay_s=float(sys.argv[2]), linger_s=float(sys.argv[3])), flush=True)
