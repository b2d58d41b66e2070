"""VIPO for small devices: runs on MicroPython (ESP32, unix) and, unchanged, on CPython."""

import gc

COLLECT_EVERY_BYTES = 8192

if hasattr(gc, "threshold"):
    # Collected early, what stays lies close together; collected late, a small heap is all holes.
    gc.threshold(COLLECT_EVERY_BYTES)
