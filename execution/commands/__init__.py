"""Commands to devices: the outbox, claims, calls by hand, and devices that know only the done flag."""
