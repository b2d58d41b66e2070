"""Commands as they come in, and the answers that were given: read with suspicion, remembered sixteen deep."""

import json

REMEMBERED = 16
MOST_DEPTH = 16
MOST_ARGUMENTS = 16
LONGEST_WORD = 64
LONGEST_WHY = 256
OPEN, CLOSE = b"[{", b"]}"
SPACE, QUOTE, BACKSLASH = 0x20, 0x22, 0x5C
WHITE = b"\t\n\r"


class BadCommand(Exception):
    """A message that is no command; `command` is its id if that can be read, or empty."""

    def __init__(self, why, command=""):
        super().__init__(why)
        self.why, self.command = why, command


def read_command(payload, whole=True):
    """Return (id, arguments, ttl_s, fence) of a message; one that is not whole was too long. Raises BadCommand."""
    if not whole:
        raise BadCommand("the message is too long for this device", first_id(bytes(payload)))
    message = read_object(payload)
    command, values, ttl_s = message.get("id"), message.get("v"), message.get("ttl_s", 1)
    if not is_plain(command):
        raise BadCommand("the id must be a text of 1 to %d plain characters" % LONGEST_WORD)
    if values is None:
        values = {}
    if not isinstance(values, dict) or len(values) > MOST_ARGUMENTS or not all(is_plain(n) for n in values):
        raise BadCommand("v must be an object with at most %d arguments" % MOST_ARGUMENTS, command)
    if isinstance(ttl_s, bool) or not isinstance(ttl_s, (int, float)):
        raise BadCommand("ttl_s must be a number", command)
    return command, values, ttl_s, fence_of(message)


def fence_of(message):
    """Return the fence of a message, which each stop raises, or None."""
    fence = message.get("fence")
    return fence if isinstance(fence, int) and not isinstance(fence, bool) and fence >= 0 else None


def first_id(payload):
    """Return the id that the beginning of a message starts with, as the server's do, or an empty text."""
    for piece in (b"{", b'"id"', b":", b'"'):
        payload = payload.strip()
        if not payload.startswith(piece):
            return ""
        payload = payload[len(piece) :]
    word = payload[: max(0, payload.find(b'"'))]
    # What is not ASCII is no id, so that each byte may stand for itself.
    word = "".join([chr(byte) for byte in word[: LONGEST_WORD + 1]])
    return word if is_plain(word) and "\\" not in word else ""


def is_plain(word):
    """Tell whether a value is a text of 1 to 64 printable ASCII characters."""
    return isinstance(word, str) and 0 < len(word) <= LONGEST_WORD and all(" " <= c <= "~" for c in word)


def read_object(payload):
    """Return the JSON object in a payload, None standing for one that was too long. Raises BadCommand."""
    if payload is None:
        raise BadCommand("the message is too long")
    check_outside(payload)
    try:
        # First to text: MicroPython's JSON takes bytes as they come, also where they are not UTF-8.
        message = json.loads(str(payload, "utf-8"))
    except (ValueError, MemoryError):
        raise BadCommand("the message is not JSON")
    if not isinstance(message, dict):
        raise BadCommand("the message must be an object")
    return message


def check_outside(payload):
    """See before parsing that a payload has no control characters, and brackets that close and are not too deep.

    MicroPython's JSON takes brackets that are crossed or never closed, and as many as there is memory. Raises
    BadCommand.
    """
    expected, in_text, escaped = bytearray(), False, False
    for byte in payload:
        if byte < SPACE and (in_text or byte not in WHITE):
            raise BadCommand("the message holds control characters")
        if in_text:
            in_text = byte != QUOTE or escaped
            escaped = byte == BACKSLASH and not escaped
        elif byte == QUOTE:
            in_text = True
        elif byte in OPEN:
            if len(expected) == MOST_DEPTH:
                raise BadCommand("the message is nested too deep")
            expected.append(byte + 2)
        elif byte in CLOSE:
            if not expected or expected[-1] != byte:
                raise BadCommand("the message is not JSON")
            expected = expected[:-1]
    if expected or in_text:
        raise BadCommand("the message is not JSON")


class Answers:
    """The last answer to each of the last 16 commands, and to the one that is being carried out.

    `known` are those of before the start: (id, answer), oldest first.
    """

    def __init__(self, known):
        self._known = list(known)

    def remember(self, command, message, running=""):
        """Keep an answer; the oldest is forgotten, but never that of the command `running`."""
        for index, (known, _) in enumerate(self._known):
            if known == command:
                self._known[index] = (command, message)
                return
        self._known.append((command, message))
        if len(self._known) > REMEMBERED:
            self._known.pop(1 if self._known[0][0] == running else 0)

    def find(self, command):
        """Return the last answer to a command, or None."""
        for known, message in self._known:
            if known == command:
                return message
        return None


def make_answer(command, status, why="", result=None):
    """Return an answer as JSON in bytes."""
    message = {"id": command, "st": status}
    if why:
        message["why"] = why[:LONGEST_WHY]
    if result is not None:
        message["result"] = result
    return json.dumps(message).encode()
