"""A program for MicroPython: sends many small messages at QoS 1 and says how it went.

usage: soak.py PORT COUNT FIRST_PACKET_ID
"""

import asyncio
import gc
import json
import sys
import time

from vipo.mqtt import Client

PORT, COUNT, FIRST = [int(word) for word in sys.argv[1:4]]
MOST_PENDING = 16
STEP_BYTES = 512
USED, LARGEST = {}, {}


def measure(when):
    """Note how much of the heap is taken, and how large the largest block is that could be had."""
    gc.collect()
    USED[when] = gc.mem_alloc()
    size = gc.mem_free()
    while size > 0:
        try:
            bytearray(size)
            break
        except MemoryError:
            size -= STEP_BYTES
    LARGEST[when] = size
    gc.collect()


async def send(client):
    """Keep a few messages waiting until all are acknowledged."""
    sent = 0
    while sent < COUNT or client.pending():
        while sent < COUNT and client.pending() < MOST_PENDING:
            client.publish("vipo/v1/dev/soak/up/ack", b"%d" % sent)
            sent += 1
            if sent in (COUNT // 10, COUNT):
                measure("first" if sent < COUNT else "last")
        await asyncio.sleep(0)


async def main():
    """Send everything over one client."""
    client = Client("127.0.0.1", PORT, "soak", "soaked")
    connections, up = [], asyncio.Event()

    def note_up():
        connections.append(1)
        up.set()

    client.on_up = note_up
    client.outbox.last_id = FIRST - 1
    task = asyncio.create_task(client.run())
    await up.wait()
    began = time.ticks_ms()
    await send(client)
    seconds = time.ticks_diff(time.ticks_ms(), began) / 1000
    task.cancel()
    print(
        json.dumps(
            {
                "sent": COUNT,
                "seconds": seconds,
                "connections": len(connections),
                "last_id": client.outbox.last_id,
                "bytes_at_a_tenth": USED["first"],
                "bytes_at_the_end": USED["last"],
                "largest_block_at_a_tenth": LARGEST["first"],
                "largest_block_at_the_end": LARGEST["last"],
            }
        )
    )


asyncio.run(main())
