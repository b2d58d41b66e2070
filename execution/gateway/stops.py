"""Stops on their way to the devices: what the database says, and the broker does not, is published, retained."""

from __future__ import annotations

import threading

from execution.floor.stop_publisher import FRESH_S, stop_topic
from execution.floor.stops import catch_up_stop, list_stops, stop_payload
from registry import services as registry
from vipo_device.protocol.clock import steady_s
from vipo_device.protocol.messages import read_stop
from vipo_device.protocol.mqtt_client import MqttClient

EVERY_S = 1.0


class Stops:
    """What this gateway knows that the broker holds. It hears what others publish: the same again is not said twice,
    and what somebody says late is put right at once."""

    def __init__(self, client: MqttClient) -> None:
        self._client = client
        self._held: dict[str, bytes] = {}
        self._looked_s = 0.0
        self._doubted = threading.Event()

    def listen(self) -> None:
        """Hear from the broker what it holds, before the connection is made."""
        self._client.subscribe(stop_topic("+"), 1, self._hear)

    def is_due(self) -> bool:
        """Tell whether it is time to look, or something was heard that does not agree with what was last said."""
        return self._doubted.is_set() or steady_s() - self._looked_s >= EVERY_S

    def publish(self, *, all_of_them: bool = False) -> None:
        """Say of each site what the database says, where the broker does not hold it, or everywhere.

        What was read too long ago, since this process slept, is not said: the next look has it anew.
        """
        self._doubted.clear()
        self._looked_s = read_s = steady_s()
        for stop in list_stops():
            held = self._held.get(stop.site, b"")
            if read_stop(held).fence is not None and (read_stop(held).fence or 0) > stop.fence:
                catch_up_stop(site=stop.site, told=read_stop(held))
                self._doubted.set()
                continue
            payload = stop_payload(stop)
            if (all_of_them or held != payload) and steady_s() - read_s <= FRESH_S:
                self._client.publish(stop_topic(stop.site), payload, retain=True, wait_s=FRESH_S)
                self._held[stop.site] = payload
                registry.count(name="mqtt_messages_out", labels=("stop",))

    def _hear(self, topic: str, payload: bytes, _retained: bool) -> None:
        """Take in what the broker holds now; runs on the network thread."""
        site = topic.split("/")[3]
        if self._held.get(site) != payload:
            self._held[site] = payload
            self._doubted.set()
