"""The cookie of a session, which only who signs out loses."""

from __future__ import annotations

from django.conf import settings
from django.contrib.sessions.middleware import SessionMiddleware
from django.http import HttpRequest, HttpResponse
from django.utils.cache import patch_vary_headers


class Sessions(SessionMiddleware):
    """Django's, but that an answer to a question never takes the cookie away.

    A session gets another key when its person changes the password or turns a second factor on. What the page had asked
    for just before is answered after that, finds no session under the key that it was asked with, and Django would tell
    the browser to forget its cookie: the new one by then, and the person would be signed out. A cookie whose session is
    gone opens nothing, so that it may stay.
    """

    def process_response(self, request: HttpRequest, response: HttpResponse) -> HttpResponse:
        """Save the session, and take its cookie away if this request ended it."""
        gone = settings.SESSION_COOKIE_NAME in request.COOKIES and request.session.is_empty()
        if gone and not _ended(request, response):
            patch_vary_headers(response, ("Cookie",))
            return response
        return super().process_response(request, response)


def _ended(request: HttpRequest, response: HttpResponse) -> bool:
    changed = request.session.modified and request.method not in {"GET", "HEAD", "OPTIONS"}
    return changed and response.status_code < 400
