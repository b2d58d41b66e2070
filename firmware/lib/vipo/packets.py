"""MQTT 3.1.1 on the wire: packets to bytes, and packets out of a stream."""

CONNECT, CONNACK, PUBLISH, PUBACK, SUBSCRIBE, SUBACK, PINGREQ, DISCONNECT = 1, 2, 3, 4, 8, 9, 12, 14
WRONG_KEY = (4, 5)
REFUSALS = {1: "protocol", 2: "client id", 3: "not ready", 4: "the key", 5: "the key"}
MOST_BYTES = 4096
HEAD_BYTES = 512
READ_BYTES = 256
SUBSCRIBE_FAILED = 0x80


class MqttFailure(Exception):
    """The connection is of no use any more; the text says why."""


class Refused(MqttFailure):
    """The broker does not let this user in with this password."""


async def read_packet(reader):
    """Return (first byte, body, whole).

    Of a body over MOST_BYTES, or one that the heap has no block for, only the first HEAD_BYTES are there, and `whole`
    is False. It is read in pieces: a stream that reads more at once copies what it has with each piece that comes.
    """
    kind = (await reader.readexactly(1))[0]
    length = await read_length(reader)
    body = room_for(length)
    for start in range(0, length, READ_BYTES):
        piece = await reader.readexactly(min(READ_BYTES, length - start))
        if start < len(body):
            body[start : start + len(piece)] = piece
    return kind, memoryview(body), len(body) == length


def room_for(length):
    """Return a bytearray for a body, or for its beginning."""
    if length <= MOST_BYTES:
        try:
            return bytearray(length)
        except MemoryError:
            pass
    return bytearray(min(length, HEAD_BYTES))


async def read_length(reader):
    """Return a packet's length, seven bits in each byte, four bytes at most."""
    length = 0
    for shift in (0, 7, 14, 21):
        byte = (await reader.readexactly(1))[0]
        length |= (byte & 0x7F) << shift
        if not byte & 0x80:
            return length
    raise MqttFailure("the broker sent nonsense")


def split_publish(kind, body):
    """Return (topic, payload, packet id or 0) of a PUBLISH; the payload is a part of the body, not a copy."""
    end = 2 + int.from_bytes(body[:2], "big")
    topic = bytes(body[2:end]).decode()
    if not kind & 0x06:
        return topic, body[end:], 0
    number = int.from_bytes(body[end : end + 2], "big")
    if not number:
        raise MqttFailure("the broker sent nonsense")
    return topic, body[end + 2 :], number


def connect_packet(client_id, user, password, keepalive_s, will):
    """Return a CONNECT with a clean session; `will` is (topic, payload, retain) or None."""
    flags = 0x02 | 0xC0
    payload = text(client_id)
    if will:
        topic, message, retain = will
        flags |= 0x04 | 0x08 | (0x20 if retain else 0)
        payload += text(topic) + blob(message)
    payload += text(user) + text(password)
    return packet(CONNECT << 4, text("MQTT"), bytes((4, flags)), keepalive_s.to_bytes(2, "big"), payload)


def subscribe_packet(number, topics):
    """Return a SUBSCRIBE for topic filters, each at QoS 1."""
    return packet(SUBSCRIBE << 4 | 2, number.to_bytes(2, "big"), *[text(t) + b"\x01" for t in topics])


def publish_head(number, topic, length, retain, again):
    """Return a PUBLISH at QoS 1 up to its payload of so many bytes; `again` says that the broker may have it already."""
    kind = PUBLISH << 4 | 0x02 | (0x08 if again else 0) | (1 if retain else 0)
    return packet(kind, text(topic), number.to_bytes(2, "big"), more=length)


def puback_packet(number):
    """Return the answer to a PUBLISH at QoS 1."""
    return bytes((PUBACK << 4, 2, number >> 8, number & 0xFF))


def packet(kind, *parts, more=0):
    """Return a packet of some parts with its length in front; `more` bytes are still to follow."""
    length, head = sum([len(part) for part in parts]) + more, bytearray((kind,))
    while True:
        byte, length = length & 0x7F, length >> 7
        head.append(byte | 0x80 if length else byte)
        if not length:
            return b"".join((bytes(head),) + parts)


def blob(data):
    """Return bytes with their length in front."""
    return len(data).to_bytes(2, "big") + data


def text(value):
    """Return a string as MQTT writes it."""
    return blob(value.encode())
