"""Run every measurement, or those named: `python -m bench [NAME …]`, a name being that of a module of this folder."""

from __future__ import annotations

import importlib
import json
import os
import sys

import django

NAMES = (
    "language",
    "rehearsal",
    "beside_rehearsals",
    "traffic",
    "lattice",
    "rooms",
    "compiled_frames",
    "devices",
    "round_trips",
    "steps",
    "firmware",
    "start",
    "paths",
    "versions",
    "library",
    "runs",
    "canvas",
    "scene",
    "scan",
    "mirror",
)


def main() -> None:
    os.environ["DJANGO_SETTINGS_MODULE"] = "tests.settings"
    django.setup()  # what starts the servers imports models; they themselves are told their own settings
    del os.environ["DJANGO_SETTINGS_MODULE"]
    chosen = sys.argv[1:] or NAMES
    for name in chosen:
        if name not in NAMES:
            sys.exit(f"There is no measurement {name!r}; choose from {', '.join(NAMES)}.")
        for figure in importlib.import_module(f"bench.{name}").measure():
            print(json.dumps({"bench": name, **figure}), flush=True)


if __name__ == "__main__":
    main()
