"""`vipo`, the command for the terminal: programs, descriptions, devices, accounts."""
