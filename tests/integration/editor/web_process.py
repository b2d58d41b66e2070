"""The real ASGI application in Daphne, as the product starts it: -m tests.integration.editor.web_process PORT."""

import os
import sys

from daphne.server import Server

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "tests.settings")

MIB = 1024 * 1024


def main() -> None:
    from vipo_site.asgi import application

    Server(
        application,
        endpoints=[f"tcp:port={sys.argv[1]}:interface=127.0.0.1"],
        websocket_max_message_size=16 * MIB,
        websocket_max_frame_size=16 * MIB,
        application_close_timeout=2,
        verbosity=0,
    ).run()


if __name__ == "__main__":
    main()
