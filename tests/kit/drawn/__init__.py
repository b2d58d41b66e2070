"""Documents that are edited by chance, and what restoring does to them."""
