"""A name server that answers every question with one address, so that phones find the set-up page by themselves."""

import asyncio
import socket

HEADER_BYTES = 12
MOST_BYTES = 512
PAUSE_S = 0.02
A_RECORD, ANY_RECORD, INTERNET = 1, 255, 1
NAME_OF_QUESTION = b"\xc0\x0c"
LIVES_S = 10


async def serve_names(address, host="0.0.0.0", port=53):
    """Answer for ever; what is no plain question is not answered."""
    listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    listener.setblocking(False)
    listener.bind(socket.getaddrinfo(host, port)[0][-1])
    try:
        while True:
            await asyncio.sleep(PAUSE_S)
            answer_one(listener, address)
    finally:
        listener.close()


def answer_one(listener, address):
    """Answer a question if one has come."""
    try:
        question, asker = listener.recvfrom(MOST_BYTES)
    except OSError:
        return
    answer = answer_to(question, address)
    if answer:
        try:
            listener.sendto(answer, asker)
        except OSError:
            pass  # the asker asks again


def answer_to(question, address):
    """Return the packet that answers a question with the address (dotted), or None for what is no question."""
    end = end_of_name(question)
    if len(question) < HEADER_BYTES or question[2] & 0xF8 or question[4:6] != b"\x00\x01" or not end:
        return None
    kind = int.from_bytes(question[end : end + 2], "big")
    wanted = kind in (A_RECORD, ANY_RECORD) and int.from_bytes(question[end + 2 : end + 4], "big") == INTERNET
    head = question[:2] + bytes((0x84 | (question[2] & 1), 0, 0, 1, 0, 1 if wanted else 0, 0, 0, 0, 0))
    answer = head + question[HEADER_BYTES : end + 4]
    if wanted:
        data = bytes([int(part) for part in address.split(".")])
        answer += NAME_OF_QUESTION + b"\x00\x01\x00\x01" + LIVES_S.to_bytes(4, "big") + b"\x00\x04" + data
    return answer


def end_of_name(question):
    """Return where the question's name ends, or 0 when it does not end within the packet."""
    at = HEADER_BYTES
    while at < len(question):
        length = question[at]
        at += 1 + length
        if length == 0:
            return at if at + 4 <= len(question) else 0
        if length > 63:
            return 0
    return 0
