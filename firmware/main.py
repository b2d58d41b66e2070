"""Start of the ESP32; everything else is in lib/vipo."""

from vipo.chip import run

run()
