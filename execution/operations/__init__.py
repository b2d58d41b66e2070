"""Runs seen from outside: what waits and for how long, what is overdue, who leads; for operators and for /metrics."""
