"""A worker of rehearsals as a process of its own: carries out what waits on the database that it is told, then ends."""

from __future__ import annotations

import sys

import django

django.setup()

from execution.rehearsals import worker  # noqa: E402


def main() -> None:
    worker.MACHINE = sys.argv[1]
    worker.carry_out_waiting()


if __name__ == "__main__":
    main()
