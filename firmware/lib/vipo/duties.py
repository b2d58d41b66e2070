"""What a device is told to do: commands and stops, carried out once each and answered for."""

import asyncio

from vipo import light as lights
from vipo.commands import Answers, BadCommand, fence_of, make_answer, read_command, read_object
from vipo.declare import check_arguments
from vipo.entrance import is_key
from vipo.portable import show_error
from vipo.work import Cancelled, Failure, Work

CONTROLS = ("pause", "resume", "cancel")


class Duties:
    """The commands of one machine; `say(answer)` sends an answer, `changed()` tells a new state.

    `running` is the task that carries a command out. It is None again when that has come to its end; one that is done
    and still stands there was ended by a fault.
    """

    def __init__(self, driver, panel, speed, output, entrance, ledger):
        self.driver, self.panel, self.speed = driver, panel, speed
        self.entrance, self._ledger = entrance, ledger
        self.say = self.changed = None
        self.work = self.running = None
        self.connected = True
        self._stops = {}
        self._fence = 0
        self._output = output or (lambda on: None)
        self._answers = Answers(ledger.answers)

    @property
    def stopped(self):
        """Tell whether any site that this machine listens to is stopped."""
        return any(active for active, _ in self._stops.values())

    def stop(self, site, payload):
        """Hold or release everything for a site; a stop that cannot be read holds, one that was taken away does not.

        One that is older than the site's last, which its fence tells, is left out.
        """
        before = self._stops.get(site, (False, 0))[1]
        active, fence = True, None
        try:
            message = read_object(payload) if payload is None or len(payload) else {"active": False}
            active, fence = message.get("active") is not False, fence_of(message)
        except BadCommand:
            pass  # it holds
        if fence is None or fence >= before:
            self._stops[site] = (active, before if fence is None else fence)
            self._fence = max(self._fence, fence or 0)
            self.shine()

    def _overtaken(self, method, fence):
        """Tell whether a stop has overtaken a command, or a reset that is not here yet lies before it.

        Neither is answered: the server sends again what still holds. Who hears several sites cannot tell whose it is.
        """
        if fence is None or len(self._stops) > 1:
            return False
        if fence < self._fence:
            return True
        self._fence = fence
        return method not in CONTROLS and any(active and fence > at for active, at in self._stops.values())

    def told(self, method, payload, whole=True):
        """Take in a command; of one that is not whole only the beginning is there."""
        try:
            command, values, ttl_s, fence = read_command(payload, whole)
        except BadCommand as error:
            self._refuse(error)
            return
        if self._overtaken(method, fence):
            return
        known = self._answers.find(command)
        if known:
            self.say(known)
        elif method in CONTROLS:
            self._steer(command, method, values.get("command"))
        elif method == "credential":
            self._take_key(command, values.get("credential"))
        else:
            why = self._objection(method, values, ttl_s)
            if why:
                self._answer(command, "REJECTED", why)
            else:
                self._begin(command, method, values)

    def _refuse(self, error):
        """Answer what cannot be read, if it says whose answer that is; a command that is known is answered as before."""
        if error.command:
            known = self._answers.find(error.command)
            if known:
                self.say(known)
            else:
                self._answer(error.command, "REJECTED", error.why)
        elif self.work is None:
            self.panel.show("Bad message", error.why)

    def _take_key(self, command, key):
        """Keep the key that the server gave; it ends this connection, and the next one begins with it."""
        try:
            why = "" if is_key(key) else "credential must be 20 to 128 printable characters"
            if not why:
                self.entrance.take(key)
        except OSError as error:
            why = "it could not be kept: %s" % error
        self._answer(command, "REJECTED" if why else "DONE", why)

    def _objection(self, method, values, ttl_s):
        if method not in self.driver.methods:
            return "there is no method %s" % method
        if ttl_s <= 0:
            return "it came too late"
        if self.stopped:
            return "the site is stopped"
        if self.work is not None:
            return "busy with %s" % self.work.command
        return check_arguments(self.driver.methods[method], values)

    def _begin(self, command, method, values):
        try:
            self._ledger.begin(command)
        except OSError as error:
            self._answer(command, "REJECTED", "it could not be kept over a power cut: %s" % error)
            return
        work = Work(command, self.speed, lambda: self.stopped, self._switch)
        # A full heap may end this at any line; there is no work without its task.
        self.running = asyncio.create_task(self._carry_out(command, method, values))
        self.work = work
        self._answer(command, "ACCEPTED")

    def _switch(self, on):
        self._output(on)
        self.driver.switched(on)

    async def _carry_out(self, command, method, values):
        self.shine()
        self._answer(command, "RUNNING")
        self.changed()
        status, why, result = "DONE", "", None
        try:
            result = await getattr(self.driver, method)(self.work, **values)
        except Cancelled:
            status, why = "CANCELED", "cancelled by the server"
            self.panel.show("Cancelled", method)
        except (Failure, OSError) as error:
            status, why = "FAILED", str(error)
        except Exception as error:  # the edge of a driver: the device must answer and work on
            show_error(error)
            status, why = "FAILED", "the driver has a fault: %r" % error
        if status == "FAILED":
            self.panel.show("Failed", why)
        self._ledger.end(command, status, why, result)
        self.work = None
        self.shine(failed=status == "FAILED")
        self.changed()
        self._answer(command, status, why, result)
        self.running = None

    def _steer(self, command, method, target):
        work = self.work
        if work is None or work.command != target:
            self._answer(command, "REJECTED", "that command is not running")
            return
        if method == "cancel":
            work.cancelled = True
        else:
            work.paused = method == "pause"
        self.shine()
        self._answer(command, "DONE")

    def _answer(self, command, status, why="", result=None):
        message = make_answer(command, status, why, result)
        self._answers.remember(command, message, self.work.command if self.work else "")
        self.say(message)

    def shine(self, failed=False):
        """Show on the status light how the machine is."""
        if self.stopped or failed or not self.connected:
            self.panel.light(lights.RED)
        elif self.work is None:
            self.panel.light(lights.GREEN)
        else:
            self.panel.light(lights.AMBER if self.work.paused else lights.BLUE)
