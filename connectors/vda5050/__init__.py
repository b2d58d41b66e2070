"""VIPO as master control of vehicles that speak VDA 5050, versions 2.0 and 2.1."""
