"""Runs against real PostgreSQL, Redis and Mosquitto, on devices that answer at once: how soon, how many, at what cost.

The load generator (`load_generator`) plays all devices over one MQTT connection and measures by its own clock, from the
answer that it gives to the next command that it hears. Servers, ours and the generator share the machine's cores.
"""

from __future__ import annotations

from collections.abc import Iterator


def measure() -> Iterator[dict[str, object]]:
    """Yield what one run and a hundred runs of one site take."""
    # what starts servers imports models; the generator, which is of this package, sets Django up by itself
    from bench.runs.servers import measure_on_servers

    yield from measure_on_servers()
