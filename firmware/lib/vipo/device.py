"""The device core: describes itself, tells its state, carries out commands once each and answers for them."""

import asyncio
import json

from vipo import panel as lights
from vipo.commands import Answers, BadCommand, make_answer, read_command, read_object
from vipo.declare import check_arguments
from vipo.portable import seconds_since, show_error, ticks_ms
from vipo.work import Cancelled, Failure, Work

STATE_EVERY_S = 30
CHECK_EVERY_S = 0.5


class Device:
    """One machine on the bus. `run()` never returns.

    `feed`, when it is set, is called twice a second while all goes well; `output` switches what the machine drives.
    """

    def __init__(self, client, driver, panel, description, boot, site="+", speed=1.0, output=None):
        self.client, self.driver, self.panel = client, driver, panel
        self.description = description
        self.boot, self.speed = boot, speed
        self.base = "vipo/v1/dev/%s/" % client.client_id
        self.sequence = 0
        self.work = None
        self.stopped = False
        self.feed = None
        self._output = output or (lambda on: None)
        self._answers = Answers()
        self._told = None
        self._told_at = 0
        self._running = None
        client.will = (self.base + "up/presence", self._presence("offline"), True)
        client.on_message, client.on_up, client.on_down = self._heard, self._up, self._down
        for topic in (self.base + "down/#", "vipo/v1/site/%s/stop" % site, "vipo/v1/srv/status"):
            client.subscribe(topic)

    async def run(self):
        """Serve for ever."""
        self.panel.show("VIPO", "connecting")
        self.panel.light(lights.AMBER)
        tasks = [asyncio.create_task(self.client.run()), asyncio.create_task(self.panel.run())]
        last = ticks_ms()
        try:
            while True:
                await asyncio.sleep(CHECK_EVERY_S / max(1.0, min(self.speed, 5.0)))
                if self.feed and not any(task.done() for task in tasks):
                    self.feed()
                if self.work is None:
                    self.driver.idle(seconds_since(last) * self.speed)
                last = ticks_ms()
                self._tell_state(seconds_since(self._told_at) > STATE_EVERY_S)
        finally:
            for task in tasks:
                task.cancel()

    def _up(self):
        if self.work is None:
            self.panel.show("VIPO online", self.client.client_id)
        self._shine()
        self._describe()

    def _down(self, reason):
        if self.work is None:
            self.panel.show("No connection", reason)
        self.panel.light(lights.RED)

    def _describe(self):
        self.client.publish(self.base + "up/desc", self.description, retain=True, replace=True)
        self.client.publish(self.base + "up/presence", self._presence("online"), retain=True, replace=True)
        self._tell_state(True)

    def _presence(self, word):
        return json.dumps({"s": word, "boot": self.boot}).encode()

    def _tell_state(self, even_if_equal):
        """Publish the state when it changed, or when it must be repeated."""
        state = {
            "boot": self.boot,
            "done": self.work is None,
            "cmd": self.work.command if self.work else "",
            "props": dict(self.driver.properties),
        }
        if not self.client.connected or (state == self._told and not even_if_equal):
            return
        self._told, self._told_at = state, ticks_ms()
        self.sequence += 1
        message = dict(state)
        message["seq"] = self.sequence
        self.client.publish(self.base + "up/state", json.dumps(message).encode(), retain=True, replace=True)

    def _heard(self, topic, payload, retained):
        """Take in a message; a payload of None was too long to be read."""
        if topic == "vipo/v1/srv/status":
            if not retained:
                self._describe()
        elif topic.endswith("/stop") and topic.startswith("vipo/v1/site/"):
            self._stop(payload)
        elif topic.startswith(self.base + "down/") and not retained:
            self._command(topic[len(self.base) + 5 :], payload)

    def _stop(self, payload):
        """Hold or release everything; a stop that cannot be read holds, one that was taken away does not."""
        try:
            self.stopped = payload != b"" and read_object(payload).get("active") is not False
        except BadCommand:
            self.stopped = True
        self._shine()

    def _command(self, method, payload):
        try:
            command, values, ttl_s = read_command(payload)
        except BadCommand as error:
            if error.command:
                self._answer(error.command, "REJECTED", error.why)
            elif self.work is None:
                self.panel.show("Bad message", error.why)
            return
        known = self._answers.find(command)
        if known:
            self._send(known)
        elif method in ("pause", "resume", "cancel"):
            self._steer(command, method, values.get("command"))
        else:
            why = self._objection(method, values, ttl_s)
            if why:
                self._answer(command, "REJECTED", why)
            else:
                self._begin(command, method, values)

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
        self.work = Work(command, self.speed, lambda: self.stopped, self._switch)
        self._answer(command, "ACCEPTED")
        self._running = asyncio.create_task(self._carry_out(command, method, values))

    def _switch(self, on):
        self._output(on)
        self.driver.switched(on)

    async def _carry_out(self, command, method, values):
        self._shine()
        self._answer(command, "RUNNING")
        self._tell_state(False)
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
        self.work = None
        self._shine(failed=status == "FAILED")
        self._tell_state(False)
        self._answer(command, status, why, result)

    def _steer(self, command, method, target):
        work = self.work
        if work is None or work.command != target:
            self._answer(command, "REJECTED", "that command is not running")
            return
        if method == "cancel":
            work.cancelled = True
        else:
            work.paused = method == "pause"
        self._shine()
        self._answer(command, "DONE")

    def _answer(self, command, status, why="", result=None):
        message = make_answer(command, status, why, result)
        self._answers.remember(command, message, self.work.command if self.work else "")
        self._send(message)

    def _send(self, answer):
        self.client.publish(self.base + "up/ack", answer)

    def _shine(self, failed=False):
        if self.stopped or failed:
            self.panel.light(lights.RED)
        elif self.work is None:
            self.panel.light(lights.GREEN)
        else:
            self.panel.light(lights.AMBER if self.work.paused else lights.BLUE)
