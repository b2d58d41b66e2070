"""Waiting for sockets does what select() does."""

from __future__ import annotations

import socket

import pytest

from vipo_device.protocol.readiness import wait_ready


def test_what_can_be_read_and_written_is_told_apart() -> None:
    here, there = socket.socketpair()
    with here, there:
        assert wait_ready([here], [], [], 0) == ([], [], [])
        assert wait_ready([here], [here], [], 0) == ([], [here], [])
        there.send(b"x")
        assert wait_ready([here], [here], [], 0) == ([here], [here], [])
        assert wait_ready([here, there], [there], [], 0) == ([here], [there], [])


def test_an_end_that_has_gone_can_be_read() -> None:
    here, there = socket.socketpair()
    with here:
        there.close()
        assert wait_ready([here], [], [], 1)[0] == [here]


def test_what_is_closed_or_no_socket_is_refused() -> None:
    closed = socket.socket()
    closed.close()
    for wrong in (closed, None):
        with pytest.raises(ValueError, match="Invalid file"):
            wait_ready([wrong], [], [], 0)
