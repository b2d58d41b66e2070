"""The shared document while people edit it: rooms, members, the y-protocol, and what is kept of it."""
