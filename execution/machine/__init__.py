"""What carries out a plan: a run's state and events in, new state and actions out. Pure."""
