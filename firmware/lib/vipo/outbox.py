"""What a client has to write: messages at QoS 1 until they are acknowledged, answers to the broker's, pings."""

from vipo.packets import PINGREQ, puback_packet, publish_head
from vipo.portable import seconds_since, ticks_ms

MOST_FLYING = 8
MOST_QUEUED = 24
FEW = 4
MOST_TOGETHER = 512
LAST_ID = 65535


class Message:
    """One message on its way; `number` is 0 until it was sent, `sent_at` are ticks, None before this connection's."""

    def __init__(self, topic, payload, retain):
        self.topic, self.payload, self.retain = topic, payload, retain
        self.number = 0
        self.sent_at = None


class Outbox:
    """The messages in their order; those that wait for the broker's answer stand first, a few at most."""

    def __init__(self):
        self.last_id = 0
        self.ping_due = False
        self.to_answer = []
        self.queue = []

    def begin(self):
        """Forget the connection before; what it left unacknowledged is sent again, in order."""
        self.ping_due, self.to_answer = False, []
        for message in self.queue:
            message.sent_at = None

    def put(self, topic, payload, retain, replace):
        """Queue a message; with `replace`, older ones of its topic that do not fly are left out.

        A full queue loses its oldest message that does not fly.
        """
        if replace:
            self.queue = [m for m in self.queue if m.topic != topic or m.sent_at is not None]
        if len(self.queue) >= MOST_QUEUED:
            self.queue.pop(self._flying())
        self.queue.append(Message(topic, payload, retain))

    def shorten(self):
        """Make room in a heap that is full: of what does not fly only the newest few stay; the server asks again."""
        flying = self._flying()
        self.queue = self.queue[:flying] + self.queue[flying:][-FEW:]

    def next_pieces(self):
        """Return what is to be written next, in pieces; small packets go together, and a large payload is not copied.

        Written one by one, each would wait until the broker's machine has confirmed the one before: 40 ms. A block for
        a copy of a description is hard to find in a small heap.
        """
        small, length = [], 0
        while length < MOST_TOGETHER:
            packet, payload = self.next_packet()
            if not packet:
                break
            small.append(packet)
            if len(payload) > MOST_TOGETHER:
                return [b"".join(small), payload]
            small.append(payload)
            length += len(packet) + len(payload)
        return [b"".join(small)] if small else []

    def next_packet(self):
        """Return (the next packet to be written or its beginning, the payload that follows), or (None, b"")."""
        if self.to_answer:
            return puback_packet(self.to_answer.pop(0)), b""
        if self.ping_due:
            self.ping_due = False
            return bytes((PINGREQ << 4, 0)), b""
        flying = self._flying()
        if flying == len(self.queue) or flying >= MOST_FLYING:
            return None, b""
        message = self.queue[flying]
        again = bool(message.number)
        message.number = message.number or self.next_id()
        message.sent_at = ticks_ms()
        size = len(message.payload)
        return publish_head(message.number, message.topic, size, message.retain, again), message.payload

    def acknowledge(self, number):
        """Drop the message that the broker has; tell whether there was one."""
        for index in range(self._flying()):
            if self.queue[index].number == number:
                self.queue.pop(index)
                return True
        return False

    def longest_wait_s(self):
        """Return for how many seconds the broker has owed an answer."""
        return seconds_since(self.queue[0].sent_at) if self._flying() else 0

    def next_id(self):
        """Return the next packet id: 1 to 65535, then from 1 again, leaving out those in use."""
        while True:
            self.last_id = self.last_id % LAST_ID + 1
            if not any(message.number == self.last_id for message in self.queue):
                return self.last_id

    def _flying(self):
        count = 0
        while count < len(self.queue) and self.queue[count].sent_at is not None:
            count += 1
        return count
