"""The device core: describes itself, tells its state, carries out commands once each and answers for them."""

import asyncio
import json

from vipo import panel as lights
from vipo.drivers import check_arguments
from vipo.portable import seconds_since, ticks_ms
from vipo.work import Cancelled, Work

REMEMBERED = 16
STATE_EVERY_S = 30
CHECK_EVERY_S = 0.5
FINAL = ("DONE", "FAILED", "REJECTED", "CANCELED")


class Device:
    """One machine on the bus. `run()` never returns."""

    def __init__(self, client, driver, panel, description, boot, site="+", speed=1.0, location=None):
        self.client, self.driver, self.panel = client, driver, panel
        self.description = description
        self.boot, self.site, self.speed = boot, site, speed
        self.location = location
        self.base = "vipo/v1/dev/%s/" % client.client_id
        self.sequence = 0
        self.work = None
        self.stopped = False
        self._answers = []
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
        talking = asyncio.create_task(self.client.run())
        last = ticks_ms()
        try:
            while True:
                await asyncio.sleep(CHECK_EVERY_S / max(1.0, min(self.speed, 5.0)))
                if self.work is None:
                    self.driver.idle(seconds_since(last) * self.speed)
                last = ticks_ms()
                self._tell_state(seconds_since(self._told_at) > STATE_EVERY_S)
        finally:
            talking.cancel()

    def _up(self):
        self.panel.show("VIPO online", self.client.client_id)
        self._shine()
        self._describe()

    def _down(self, reason):
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
        if self.location:
            state["loc"] = self.location
        if not self.client.connected or (state == self._told and not even_if_equal):
            return
        self._told, self._told_at = state, ticks_ms()
        self.sequence += 1
        message = dict(state)
        message["seq"] = self.sequence
        self.client.publish(self.base + "up/state", json.dumps(message).encode(), retain=True, replace=True)

    def _heard(self, topic, payload, retained):
        if topic == "vipo/v1/srv/status":
            if not retained:
                self._describe()
        elif topic.endswith("/stop") and topic.startswith("vipo/v1/site/"):
            self._stop(payload)
        elif topic.startswith(self.base + "down/") and not retained:
            self._command(topic[len(self.base) + 5 :], payload)

    def _stop(self, payload):
        """Hold or release everything; a stop that cannot be read holds."""
        try:
            self.stopped = bool(payload) and bool(json.loads(payload).get("active", True))
        except (ValueError, AttributeError):
            self.stopped = True
        self._shine()

    def _command(self, method, payload):
        try:
            message = json.loads(payload)
            command, values = message["id"], message.get("v") or {}
            ttl_s = message.get("ttl_s", 1)
        except (ValueError, KeyError, TypeError, AttributeError):
            self.panel.show("Bad message", method)
            return
        if not isinstance(command, str) or not isinstance(values, dict):
            self.panel.show("Bad message", method)
        elif self._answer_again(command):
            return
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
        if isinstance(ttl_s, (int, float)) and ttl_s <= 0:
            return "it came too late"
        if self.stopped:
            return "the site is stopped"
        if self.work is not None:
            return "busy with %s" % self.work.command
        return check_arguments(self.driver.methods[method], values)

    def _begin(self, command, method, values):
        self.work = Work(command, self.speed, lambda: self.stopped)
        self._answer(command, "ACCEPTED")
        self._running = asyncio.create_task(self._carry_out(command, method, values))

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
        except (OSError, ValueError, RuntimeError) as error:
            status, why = "FAILED", str(error)
            self.panel.show("Failed", why)
        self.work = None
        self._shine()
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
        message = {"id": command, "st": status}
        if why:
            message["why"] = why
        if result is not None:
            message["result"] = result
        self._remember(command, message)
        self.client.publish(self.base + "up/ack", json.dumps(message).encode())

    def _remember(self, command, message):
        """Keep the last answer of each of the last 16 commands."""
        for index, (known, _) in enumerate(self._answers):
            if known == command:
                self._answers[index] = (command, message)
                return
        self._answers.append((command, message))
        if len(self._answers) > REMEMBERED:
            self._answers.pop(0)

    def _answer_again(self, command):
        for known, message in self._answers:
            if known == command:
                self.client.publish(self.base + "up/ack", json.dumps(message).encode())
                return True
        return False

    def _shine(self):
        if self.stopped:
            self.panel.light(lights.RED)
        elif self.work is None:
            self.panel.light(lights.GREEN)
        else:
            self.panel.light(lights.AMBER if self.work.paused else lights.BLUE)
