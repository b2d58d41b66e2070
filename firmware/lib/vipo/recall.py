"""What the ledger says when the board starts; not needed any more after that."""

from vipo.commands import BadCommand, is_plain, make_answer, read_object
from vipo.ledger import KEPT

LONGEST_FILE = 4096
CUT = "the power was cut while it was under way; see what it left, then call it again"


def read_ledger(path):
    """Return the (id, answer) of the ledger's commands, oldest first; one that was still running has failed."""
    try:
        with open(path, "rb") as file:
            lines = file.read(LONGEST_FILE).split(b"\n")
    except OSError:
        return []
    return [known for known in [recall(line) for line in lines] if known][-KEPT:]


def recall(line):
    """Return (id, answer) of a line, or None when it cannot be read."""
    try:
        message = read_object(line)
    except BadCommand:
        return None
    command = message.get("id")
    if not is_plain(command):
        return None
    return command, make_answer(command, "FAILED", CUT) if message.get("st") == "RUNNING" else line
