"""Documents that are edited by chance, what restoring does to them, and how a client hears of what others draw."""
