"""A connection to the broker that many stand-ins share: to each its part of it looks like a client of its own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from vipo_device.kit.connection import Handler


class Speaker(Protocol):
    """What these connections need of the client that they share (`MqttClient`)."""

    @property
    def connected(self) -> bool:
        """Tell whether the connection stands."""

    def publish(self, topic: str, payload: bytes, *, qos: int = 1, retain: bool = False) -> None:
        """Send a message."""


class SharedConnection:
    """One stand-in's part of a connection; a message is given to it by `hear`."""

    def __init__(self, speaker: Speaker) -> None:
        self._speaker, self._is_cut = speaker, False
        self._handlers: dict[str, Handler] = {}
        self._callbacks: list[Callable[[], None]] = []

    @property
    def connected(self) -> bool:
        """Tell whether it can speak."""
        return self._speaker.connected and not self._is_cut

    def subscribe(self, topic: str, _qos: int, callback: Handler) -> None:
        """Hear a topic, or all that begin with what stands before `#`."""
        self._handlers[topic] = callback

    def on_connected(self, callback: Callable[[], None]) -> None:
        """Call back each time that the connection stands."""
        self._callbacks.append(callback)

    def publish(self, topic: str, payload: bytes, *, qos: int = 1, retain: bool = False) -> None:
        """Send a message; none is retained: what a stand-in was like says nothing once the device is real again."""
        if not self._is_cut:
            self._speaker.publish(topic, payload, qos=qos)

    def start(self) -> None:
        """Say that it can speak, if it can."""
        if self.connected:
            self.say_connected()

    def stop(self) -> None:
        """Speak and hear no more; what was said is sent by the client that it shares."""
        self.cut()

    def cut(self) -> None:
        """Speak and hear no more."""
        self._is_cut = True
        self._handlers.clear()

    def say_connected(self) -> None:
        """Tell that the connection stands."""
        for callback in self._callbacks:
            callback()

    def hear(self, topic: str, payload: bytes, *, retained: bool) -> None:
        """Give a message to whoever asked for its topic."""
        for asked, handler in list(self._handlers.items()):
            if topic == asked or (asked.endswith("#") and topic.startswith(asked[:-1])):
                handler(topic, payload, retained)
