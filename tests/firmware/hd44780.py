"""A model of the LCD 1602: the bytes on the I2C bus go through the PCF8574 into an HD44780, which shows a text.

Times and waits are those of the HD44780U data sheet (Hitachi, ADE-207-272). What the display would not understand,
or not in that time, is an AssertionError.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

RS, READ, ENABLE, BACKLIGHT = 0x01, 0x02, 0x04, 0x08
BITS_A_BYTE = 9
PULSE_US = 0.45
CYCLE_US = 1.0
WORK_US, LONG_WORK_US = 37.0, 1520.0
POWER_ON_US, FIRST_RESET_US, SECOND_RESET_US = 40_000.0, 4_100.0, 100.0
COLUMNS = 16
STILL_US = 5000.0


def levels(record: Iterable[Sequence[Any]], address: int) -> Iterator[tuple[float, int]]:
    """Yield (microseconds, the PCF8574's outputs) for each byte that was recorded for its address."""
    for entry in record:
        if entry[1] != "write" or entry[2] != address:
            continue
        byte_us = BITS_A_BYTE * 1e6 / entry[3]
        for index, value in enumerate(entry[4]):
            yield entry[0] + (index + 2) * byte_us, value


@dataclass
class Hd44780:
    """The display's controller; `bits` and `half` say how it was left by whatever was before."""

    bits: int = 8
    half: int | None = None
    resets: int = 0
    lit: bool = False
    on: bool = False
    two_lines: bool = False
    memory: dict[int, int] = field(default_factory=dict)
    address: int = 0
    step: int = 1
    busy_until_us: float = 0.0
    _last: int = 0
    _rose_us: float = 0.0
    _fell_us: float = -1e9
    _reset_us: float = 0.0

    def see(self, at_us: float, pins: int) -> None:
        """Take the levels on its pins from a moment on."""
        assert not pins & READ, "the driver must never read: the backpack's outputs would fight the display's"
        rises, falls = pins & ~self._last & ENABLE, self._last & ~pins & ENABLE
        changed = (pins ^ self._last) & 0xF0 | (pins ^ self._last) & RS
        if rises:
            assert not changed & RS, "RS must be at rest before E rises"
            assert at_us - self._rose_us >= CYCLE_US
            self._rose_us = at_us
        if falls:
            assert at_us - self._rose_us >= PULSE_US, "E was high for too short a time"
            assert not changed, "the data must be at rest when E falls"
            self._take(at_us, pins)
        if self._last & pins & ENABLE:
            assert not changed, "the data must be at rest while E is high"
        self._last, self.lit = pins, bool(pins & BACKLIGHT)

    def _take(self, at_us: float, pins: int) -> None:
        nibble = pins >> 4
        if self.resets < 3 and nibble == 3 and not pins & RS:
            self._check_reset(at_us)
        if self.bits == 8:
            self._do(at_us, nibble << 4, pins & RS)
        elif self.half is None:
            assert at_us >= self.busy_until_us, f"busy for {self.busy_until_us - at_us:.0f} us more"
            self.half = nibble
        else:
            value, self.half = self.half << 4 | nibble, None
            self._do(at_us, value, pins & RS)

    def _check_reset(self, at_us: float) -> None:
        """The three function sets of figure 24, with their waits."""
        needed = (POWER_ON_US, FIRST_RESET_US, SECOND_RESET_US)[self.resets]
        assert at_us - self._reset_us >= needed, f"reset {self.resets + 1} came too early"
        self.resets, self._reset_us = self.resets + 1, at_us

    def _do(self, at_us: float, value: int, data: int) -> None:
        assert at_us >= self.busy_until_us, f"busy for {self.busy_until_us - at_us:.0f} us more"
        self.busy_until_us = at_us + (LONG_WORK_US if not data and value in (1, 2, 3) else WORK_US)
        if data:
            self.memory[self.address] = value
            self.address += self.step
        elif value & 0x80:
            self.address = value & 0x7F
        elif value & 0x20:
            self.bits, self.two_lines = (8 if value & 0x10 else 4), bool(value & 0x08)
        elif value & 0x08:
            self.on = bool(value & 0x04)
        elif value & 0x04:
            self.step = 1 if value & 0x02 else -1
            assert not value & 0x01, "the whole display would wander"
        elif value == 1:
            self.memory, self.address, self.step = {}, 0, 1
        elif value & 0x02:
            self.address = 0

    @property
    def lines(self) -> tuple[str, str] | None:
        """What a person reads: nothing unless the display is set up, on and lit."""
        if not (self.resets == 3 and self.on and self.lit and self.two_lines and self.bits == 4):
            return None
        rows = [[self.memory.get(start + i, 0x20) for i in range(COLUMNS)] for start in (0x00, 0x40)]
        assert all(0x20 <= code <= 0x7D and code != 0x5C for row in rows for code in row)
        first, second = ("".join(map(chr, row)) for row in rows)
        return first, second


def texts(
    record: Iterable[Sequence[Any]], address: int = 0x27, display: Hd44780 | None = None
) -> list[tuple[str, str]]:
    """Return every pair of lines that stood still on the display for 5 ms or more, in order."""
    display = display or Hd44780()
    seen: list[tuple[str, str]] = []
    before_us = 0.0
    for at_us, pins in levels(record, address):
        if at_us - before_us > STILL_US and (lines := display.lines):
            seen.append(lines)
        display.see(at_us, pins)
        before_us = at_us
    if lines := display.lines:
        seen.append(lines)
    return [lines for index, lines in enumerate(seen) if index == 0 or lines != seen[index - 1]]
