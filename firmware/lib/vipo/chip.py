"""The life of an ESP32: Wi-Fi, the clock, then the machine that config.json describes; or the set-up page.

What is needed only for a while is loaded for a while: the heap is small.
"""

import time

import machine
from vipo.portable import forget, show_error

SHOWN_S = 5


class Board:
    """The pins of the board, and what switches its output: None without one."""

    def __init__(self):
        self.pins, self.output = {}, None

    def take(self, named):
        """Use the pins that are named, or the usual ones; return why the named ones cannot be used."""
        from vipo.pins import find_pins, make_output

        self.pins, fault = find_pins(named)
        self.output = make_output(self.pins)
        forget("pins")
        return fault

    def panel(self):
        """Return the panel of the board."""
        from vipo.board import make_panel

        return make_panel(self.pins)


def run():
    """Run for ever; whatever goes wrong ends in a restart, with the output off and the reason on the display."""
    board = Board()
    try:
        try:
            device = prepare(board)
            forget("ready", "configuration", "checks")
            if device:
                import asyncio

                asyncio.run(device.run())
        finally:
            if board.output:
                board.output(False)
    except Exception as error:  # the edge of the program; Ctrl-C goes through, to whoever works on the board
        report(error, board)
    machine.reset()


def report(error, board):
    """Show why the program ended, if that can still be shown."""
    show_error(error)
    try:
        board.panel().show("Fault", str(error))
    except Exception as other:  # the board starts again whatever its panel does
        show_error(other)
    time.sleep(SHOWN_S)


def prepare(board):
    """Return the machine that the configuration describes; None after the set-up page, or when no Wi-Fi came."""
    from vipo.ready import look_up, make_ready

    configuration, fault = look_up()
    fault = board.take(configuration.get("pins")) or fault
    if not fault and not is_set_up_due(board.pins):
        return make_ready(configuration, board)
    del look_up, make_ready
    forget("ready", "configuration")
    from vipo.setting_up import set_up

    set_up(board.panel(), fault)
    return None


def is_set_up_due(pins):
    """Tell whether somebody asks for the set-up page."""
    from vipo.button import was_asked

    return was_asked(pins)
