"""What joins the apps to one product."""

from vipo_site.celery import app as celery_app

__all__ = ["celery_app"]
