"""A program for MicroPython: tries every driver, and prints what it declares, describes, shows and answers.

usage: rehearse_drivers.py FOLDER     (input: JSON lines of [driver, options, [[method, arguments], …]])
"""

import asyncio
import json
import sys
import time

from vipo.declare import check_arguments
from vipo.describe import describe
from vipo.drivers import make_driver
from vipo.panel import Panel
from vipo.work import Failure, Work

SPEED = 5000


class Unchecked(Panel):
    """Keeps what the LCD showed."""

    def __init__(self):
        super().__init__()
        self.seen = []

    def _draw(self):
        self.seen.append([line.rstrip() for line in self.lines])


async def call(driver, panel, method, arguments):
    """Return what became of one command."""
    why = check_arguments(driver.methods[method], arguments)
    if why:
        return {"refused": why}
    switched, times, panel.seen = [], [], []

    def switch(on):
        if not switched or switched[-1] != on:
            switched.append(on)
            times.append(time.ticks_us())
        driver.switched(on)

    try:
        result = await getattr(driver, method)(Work("c1", SPEED, lambda: False, switch), **arguments)
    except Failure as error:
        return {"failed": str(error)}
    shortest = min([time.ticks_diff(later, earlier) for earlier, later in zip(times, times[1:])] or [0])  # noqa: B905, RUF007
    told = {"result": result, "shown": panel.seen, "switched": switched, "properties": driver.properties}
    told["shortest_us"] = shortest
    return told


def main():
    """Try each line's driver."""
    for line in sys.stdin:
        name, options, calls = json.loads(line)
        panel = Unchecked()
        driver = make_driver(name, panel, options)
        text = describe("machine01", driver, {"site": "hall"}).decode()
        answers = [asyncio.run(call(driver, panel, method, arguments)) for method, arguments in calls]
        print(json.dumps({"description": text, "order": driver.order, "answers": answers}))


main()
