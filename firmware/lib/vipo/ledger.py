"""What was begun and how it ended, kept in flash: after a power cut a command is answered for, and not done again."""

from vipo.commands import make_answer
from vipo.portable import show_error, write_file

KEPT = 2
LONGEST_ANSWER = 512


class Ledger:
    """The newest two commands that were begun: (id, last answer), oldest first; their answers are the file's lines."""

    def __init__(self, path, answers):
        self._path, self.answers = path, answers

    def begin(self, command):
        """Keep that a command begins. Raises OSError; it must not begin then."""
        answers = self.answers[1 - KEPT :] + [(command, make_answer(command, "RUNNING"))]
        self._write(answers)
        self.answers = answers

    def end(self, command, status, why, result):
        """Keep how the newest command ended, with a small result; what cannot be written is kept with the next one."""
        answer = make_answer(command, status, why, result)
        if len(answer) > LONGEST_ANSWER:
            answer = make_answer(command, status, why)
        self.answers[-1] = (command, answer)
        try:
            self._write(self.answers)
        except (OSError, MemoryError) as error:
            show_error(error)

    def _write(self, answers):
        write_file(self._path, "\n".join([answer.decode() for _, answer in answers]))
