"""The site: what joins the apps to one product."""

from django.apps import AppConfig


class VipoSiteConfig(AppConfig):
    """Settings of the joining app."""

    name = "vipo_site"
