"""VIPO for small devices: runs on MicroPython (ESP32, unix) and, unchanged, on CPython."""
