"""The embedded MQTT broker's life: amqtt in a thread of this process, with VIPO's own rules (see `broker`)."""

from __future__ import annotations

import asyncio
import logging
import threading

from amqtt.errors import BrokerError

from vipo_device.protocol.errors import VipoError
from vipo_site.embedded_broker.access_control import AccessControl, CheckPassword, PasswordAccess, RegistryAccess
from vipo_site.embedded_broker.broker import VipoBroker

START_TIMEOUT_S = 15.0


class PortInUse(VipoError):
    """Another program listens on the MQTT port."""

    code = "port_in_use"
    status = 503


class BrokerFailed(VipoError):
    """The embedded broker could not begin, for a reason that the message names."""

    code = "broker_failed"
    status = 503


class EmbeddedBroker:
    """A running broker; `port` is the one it got, `stop()` ends it."""

    def __init__(self, *, host: str, port: int, server_password: str, access_control: AccessControl) -> None:
        self.host, self.port = host, port
        self._rules = (server_password, access_control)
        self._ready = threading.Event()
        self._failure: Exception | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._stopping: asyncio.Event | None = None
        self._thread = threading.Thread(target=self._run, name="mqtt-broker", daemon=True)

    def start(self) -> None:
        """Begin; returns when the port is open, raises PortInUse or BrokerFailed otherwise."""
        self._thread.start()
        if not self._ready.wait(START_TIMEOUT_S):
            raise BrokerFailed(f"The MQTT broker did not begin within {START_TIMEOUT_S:.0f} s. Start VIPO again.")
        if self._failure is not None:
            raise self._failure

    def stop(self) -> None:
        """End all connections and the thread; harmless when it has ended already."""
        if self._loop is not None and self._stopping is not None and self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._stopping.set)
        self._thread.join(timeout=10)

    @property
    def running(self) -> bool:
        """True while the broker's thread serves."""
        return self._thread.is_alive() and self._ready.is_set() and self._failure is None

    def _run(self) -> None:
        for name in ("amqtt", "transitions"):
            logging.getLogger(name).setLevel(logging.CRITICAL)
        try:
            # Not asyncio.run: it would wait for ever for a task of amqtt that does not let itself be cancelled.
            loop = asyncio.new_event_loop()
            try:
                loop.run_until_complete(self._serve())
            finally:
                loop.run_until_complete(_cancel_the_rest())
                loop.close()
        except (BrokerError, OSError) as error:
            self._failure = self._explain(error)
        finally:
            self._ready.set()

    async def _serve(self) -> None:
        self._loop, self._stopping = asyncio.get_running_loop(), asyncio.Event()
        broker = VipoBroker(f"{self.host}:{self.port}", *self._rules)
        await broker.start()
        self.port = broker.bound_port
        self._ready.set()
        watching = asyncio.create_task(broker.end_whoever_must_go())
        await self._stopping.wait()
        watching.cancel()
        await broker.end()

    def _explain(self, error: Exception) -> Exception:
        cause = error.__cause__ if isinstance(error.__cause__, OSError) else error
        if isinstance(cause, OSError) and "in use" in str(cause):
            return PortInUse(
                f"The MQTT port {self.port} is in use by another program. "
                "Stop that program, or set VIPO_MQTT_PORT to a free port.",
            )
        return BrokerFailed(f"The MQTT broker cannot listen on {self.host}:{self.port}: {cause}.")


def start_broker(
    *,
    port: int,
    host: str = "127.0.0.1",
    server_password: str | None = None,
    check_password: CheckPassword | None = None,
) -> EmbeddedBroker:
    """Start the embedded broker on `port` (0: any free one) for the user `server` and for the registry's devices.

    The server's password is the one in the setting VIPO_MQTT unless one is given; `check_password(user, password)`
    stands in for the registry where there is none.
    """
    if server_password is None:
        from django.conf import settings

        server_password = str(settings.VIPO_MQTT["password"])
    access_control = PasswordAccess(check_password) if check_password else RegistryAccess()
    broker = EmbeddedBroker(host=host, port=port, server_password=server_password, access_control=access_control)
    broker.start()
    return broker


async def _cancel_the_rest() -> None:
    """Cancel what still runs in this loop, and wait a moment for it."""
    others = [task for task in asyncio.all_tasks() if task is not asyncio.current_task()]
    for task in others:
        task.cancel()
    if others:
        await asyncio.wait(others, timeout=1.0)
    await asyncio.sleep(0.01)  # sockets close one turn after their connections
