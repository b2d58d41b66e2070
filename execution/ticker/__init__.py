"""What happens because time passes: due timers, hints that were lost, alerts."""
