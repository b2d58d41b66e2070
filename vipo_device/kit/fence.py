"""What of the server's messages is too old for a device: overtaken by a stop, or sent late by who slept meanwhile."""

from __future__ import annotations

from vipo_device.protocol.messages import CONTROLS, DeviceCommand, StopMessage


class Fence:
    """The newest fence that a device has heard; messages without one are taken as they come.

    What is too old gets no answer: if it still holds, the server sends it again with the fence of that moment.
    """

    def __init__(self) -> None:
        self._newest = 0
        self._stop = StopMessage(active=False)

    def takes_stop(self, stop: StopMessage) -> bool:
        """Tell whether a stop counts; one that is older than the last does not."""
        if stop.fence is not None:
            if stop.fence < (self._stop.fence or 0):
                return False
            self._newest = max(self._newest, stop.fence)
        self._stop = StopMessage(stop.active, self._stop.fence if stop.fence is None else stop.fence)
        return True

    def takes_command(self, command: DeviceCommand) -> bool:
        """Tell whether a command counts.

        One that is newer than the stop that holds the device shows that the stop was reset, which is on its way.
        """
        if command.fence is None:
            return True
        if command.fence < self._newest:
            return False
        self._newest = command.fence
        is_ahead = self._stop.active and command.fence > (self._stop.fence or 0)
        return command.method in CONTROLS or not is_ahead
