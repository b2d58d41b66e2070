"""A number of objects that is remembered over a restart."""

import os


class Count:
    """How many there are, from 0 to `most`; kept in a file when there is one to be kept in."""

    def __init__(self, path, most, at_first):
        self.path, self.most = path, most
        self.value = self._read(at_first)

    def change(self, by):
        """Add or take away, within the limits, and keep it."""
        self.set(self.value + by)

    def set(self, value):
        """Say how many there are, and keep it; a power cut leaves the old number or the new one."""
        self.value = max(0, min(self.most, int(value)))
        if self.path:
            with open(self.path + ".new", "w") as file:
                file.write(str(self.value))
            os.rename(self.path + ".new", self.path)

    def _read(self, at_first):
        try:
            with open(self.path) as file:
                return max(0, min(self.most, int(file.read())))
        except (OSError, ValueError, TypeError):
            return at_first
