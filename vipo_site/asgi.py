"""HTTP and sockets."""

from __future__ import annotations

import os
from typing import Any

from django.core.asgi import get_asgi_application

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "vipo_site.settings")
http = get_asgi_application()

import servestatic.utils  # noqa: E402
from channels.auth import AuthMiddlewareStack  # noqa: E402 - models load only after Django is set up
from channels.routing import ProtocolTypeRouter, URLRouter  # noqa: E402
from django.conf import settings  # noqa: E402
from django.core.management import call_command  # noqa: E402
from django.urls import path, re_path  # noqa: E402
from servestatic import ServeStaticASGI  # noqa: E402

from editor.rooms.socket import ProgramSocket, close_hub  # noqa: E402
from execution.services import open_publisher  # noqa: E402
from execution.wall.socket import WallSocket  # noqa: E402
from registry.api.site_socket import SiteSocket  # noqa: E402
from vipo_site.http.entrance import BehindProxies, OwnPagesOnly, leave_forms_to_django  # noqa: E402
from vipo_site.http.gc_pause import leave_out_what_stays  # noqa: E402
from vipo_site.http.heartbeat import beat_while_serving  # noqa: E402
from vipo_site.http.memory import give_back_large_blocks  # noqa: E402
from vipo_site.http.middleware import add_headers  # noqa: E402
from vipo_site.http.shutdown import keep_rooms_at_end  # noqa: E402

BLOCK_BYTES = 262_144
"""Files go out in blocks of so much instead of 8 KB: each is a turn in a thread of its own."""


async def refuse_socket(_scope: Any, receive: Any, send: Any) -> None:
    """Close a socket whose address nobody serves; accepted first, since a browser learns no code otherwise."""
    await receive()
    await send({"type": "websocket.accept"})
    await send({"type": "websocket.close", "code": 4404})


if not settings.VIPO_DEMO:
    # Nobody signs in with a password of the demo after the demo, also where nobody ran `manage.py prepare`.
    call_command("end_demo")

keep_rooms_at_end(close_hub)
if settings.SERVED:
    # Beside the gateways, a stop's second way to the devices; where all is one process it would be the same one.
    open_publisher(mqtt=settings.VIPO_MQTT)
beat_while_serving()
routes = ProtocolTypeRouter(
    {
        "http": http,
        "websocket": OwnPagesOnly(
            AuthMiddlewareStack(
                URLRouter(
                    [
                        path("ws/site/<slug:slug>", SiteSocket.as_asgi()),
                        path("ws/program/<uuid:program>", ProgramSocket.as_asgi()),
                        path("ws/wall", WallSocket.as_asgi()),
                        re_path(r"", refuse_socket),  # type: ignore[arg-type]  # the stubs know pages only
                    ]
                )
            ),
            settings.ALLOWED_HOSTS,
            settings.CSRF_TRUSTED_ORIGINS,
        ),
    }
)

servestatic.utils.ASGI_BLOCK_SIZE = BLOCK_BYTES
# Everything of the built frontend but its page, which Django serves with the CSRF cookie.
files = ServeStaticASGI(
    routes,
    root=settings.FRONTEND_DIST if settings.FRONTEND_DIST.exists() else None,
    index_file=False,
    immutable_file_test=r"^/assets/.+-[A-Za-z0-9_-]{8}\.\w+$",
    max_age=3600,
    add_headers_function=lambda headers, _path, _url: add_headers(headers),
    allow_all_origins=False,
)
files.files.pop("/index.html", None)
application = BehindProxies(files, settings.VIPO_PROXIES)
give_back_large_blocks()
leave_out_what_stays()
leave_forms_to_django()
