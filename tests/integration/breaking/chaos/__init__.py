"""Runs over several sites while everything beneath them is killed, frozen, flushed, restarted and cut off.

The log of the devices is the judge. `scripts/chaos.py` plays as many runs as wanted, a test a few.
"""
