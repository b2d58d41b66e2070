"""Where requests go: the API, and the frontend's one page for everything else."""

from __future__ import annotations

from django.conf import settings
from django.db import DatabaseError, connection
from django.http import HttpRequest, HttpResponse, JsonResponse
from django.urls import path, re_path
from django.views.decorators.csrf import ensure_csrf_cookie

from vipo_site.http.api import api, problem
from vipo_site.http.metrics import metrics
from vipo_site.http.thing_directory import directory_urls


@ensure_csrf_cookie
def page(request: HttpRequest) -> HttpResponse:
    """Serve the single page; its router shows the screen that the address names."""
    index = settings.FRONTEND_DIST / "index.html"
    if not index.exists():
        return HttpResponse("The frontend is not built. Run `make frontend`.", status=503, content_type="text/plain")
    response = HttpResponse(index.read_bytes(), content_type="text/html; charset=utf-8")
    response["Cache-Control"] = "no-cache"
    return response


def health(request: HttpRequest) -> JsonResponse:
    """Tell a supervisor whether this process can serve: whether the database answers."""
    try:
        with connection.cursor() as cursor:
            cursor.execute("SELECT 1")
    except DatabaseError as error:
        return JsonResponse({"ok": False, "database": type(error).__name__}, status=503)
    return JsonResponse({"ok": True, "database": "ok"})


def no_such_call(request: HttpRequest) -> HttpResponse:
    """Answer an API address that does not exist as the API does, not with a page."""
    return problem(404, "not_found", "There is no such call. See docs/api.md.")


handler400, handler500 = "vipo_site.http.middleware.tell_unreadable", "vipo_site.http.middleware.tell_failure"
urlpatterns = [
    path("api/", api.urls),
    path("health", health),
    path("metrics", metrics),
    *directory_urls(),
    re_path(r"^(?:api|ws)/.*$", no_such_call),
    re_path(r"^(?!static/|assets/).*$", page),
]
