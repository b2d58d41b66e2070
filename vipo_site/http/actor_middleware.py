"""Who acts, for what is changed while a request is answered: the record of a site names them."""

from __future__ import annotations

from collections.abc import Callable

from django.http import HttpRequest, HttpResponse

from registry.services import acting


class ActorMiddleware:
    """Goes around the call itself; who asks is looked up only if something is written."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        """Answer."""
        with acting(request):
            return self.get_response(request)
