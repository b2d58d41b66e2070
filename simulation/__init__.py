"""The simulated world of a site: what moves in it, its physics, and the twin that speaks for virtual devices."""
