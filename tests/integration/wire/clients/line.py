"""A line to a broker that can lose what is said over it, break, and be mended."""

from __future__ import annotations

import socket
import threading
from contextlib import suppress


class Line:
    """A port that leads to another one of this machine."""

    def __init__(self, port: int) -> None:
        self._broker = port
        self._ends: list[socket.socket] = []
        self._is_losing = False
        self._entrance = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._entrance.getsockname()[1]
        self._serve()

    def lose(self) -> None:
        """Let nothing that is said from now on arrive; who speaks notices nothing."""
        self._is_losing = True

    def cut(self) -> None:
        """End the connections, and let no new one in."""
        self._entrance.shutdown(socket.SHUT_RDWR)
        self._entrance.close()
        for end in self._ends:
            with suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
        self._ends.clear()

    def mend(self) -> None:
        """Lead to the broker again, by the same port."""
        self._is_losing = False
        self._entrance = socket.create_server(("127.0.0.1", self.port))
        self._serve()

    def _serve(self) -> None:
        threading.Thread(target=self._let_in, args=(self._entrance,), daemon=True).start()

    def _let_in(self, entrance: socket.socket) -> None:
        with suppress(OSError):
            while True:
                here, _ = entrance.accept()
                there = socket.create_connection(("127.0.0.1", self._broker))
                self._ends += (here, there)
                for source, target in ((here, there), (there, here)):
                    threading.Thread(target=self._carry, args=(source, target), daemon=True).start()

    def _carry(self, source: socket.socket, target: socket.socket) -> None:
        with suppress(OSError), source, target:
            while said := source.recv(65_536):
                if not self._is_losing:
                    target.sendall(said)
