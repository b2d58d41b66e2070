"""Devices that are simulated in place of the real ones: switched by people, played by a process of VIPO."""
