"""Start of the ESP32: join the Wi-Fi, then be the machine that config.json describes."""

import asyncio
import sys
import time

import network
from vipo.panel import ConsolePanel
from vipo.start import make_device, read_configuration

WIFI_TIMEOUT_S = 30


def join_wifi(name, password):
    """Block until the network is there; start the chip again when it does not come."""
    station = network.WLAN(network.STA_IF)
    station.active(True)
    station.connect(name, password)
    for _ in range(WIFI_TIMEOUT_S * 10):
        if station.isconnected():
            return
        time.sleep(0.1)
    import machine

    machine.reset()


def main():
    """Run for ever."""
    configuration = read_configuration("config.json")
    join_wifi(configuration["wifi_name"], configuration["wifi_password"])
    asyncio.run(make_device(configuration, ConsolePanel(sys.stdout)).run())


main()
