"""Devices of other worlds, brought in as VIPO devices over VIPO's own protocol."""
