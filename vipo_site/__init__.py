"""What joins the apps to one product."""

import gc

# Loading makes 270,000 objects that stay; to look through them at every 700th takes a sixth of a web process's start.
gc.set_threshold(20_000, 10, 10)

from vipo_site.celery import app as celery_app  # noqa: E402 - the collector is set before anything is loaded

__all__ = ["celery_app"]
