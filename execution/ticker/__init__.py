"""What happens by the clock: timers, lost commands, alerts."""
