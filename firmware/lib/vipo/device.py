"""The device core: describes itself, tells its state, and hands what it hears to its duties."""

import asyncio
import json

from vipo import light as lights
from vipo.portable import seconds_since, ticks_ms

STATE_EVERY_S = 25
CHECK_EVERY_S = 0.5


class Device:
    """One machine on the bus. `run()` never returns.

    `feed`, when it is set, is called twice a second while all goes well; `site` is a short name, or + for any.
    """

    def __init__(self, client, duties, description, boot, site):
        self.client, self.duties, self.panel = client, duties, duties.panel
        self.description = description
        self.boot = boot
        self.base = "vipo/v1/dev/%s/" % client.client_id
        self.sequence = 0
        self.feed = None
        self._told = None
        self._told_at = 0
        answers = self.base + "up/ack"
        duties.say = lambda answer: client.publish(answers, answer)
        duties.changed = lambda: self._tell_state(False)
        client.will = (self.base + "up/presence", self._presence("offline"), True)
        client.on_message, client.on_up, client.on_down = self._heard, self._up, self._down
        for topic in (self.base + "down/#", "vipo/v1/site/%s/stop" % site, "vipo/v1/srv/status"):
            client.subscribe(topic)

    async def run(self):
        """Serve for ever; what ends a part of it is raised."""
        self.panel.show("VIPO", "connecting")
        self.panel.light(lights.AMBER)
        tasks = [asyncio.create_task(self.client.run()), asyncio.create_task(self.panel.run())]
        speed, last = self.duties.speed, ticks_ms()
        try:
            while True:
                await asyncio.sleep(CHECK_EVERY_S / max(1.0, min(speed, 5.0)))
                for task in tasks:
                    if task.done():
                        await task  # raises what ended it
                work = self.duties.running
                if work and work.done():
                    await work  # so does this: only a restart answers for a command that was left in its middle
                if self.feed:
                    self.feed()
                if self.duties.work is None:
                    self.duties.driver.idle(seconds_since(last) * speed)
                last = ticks_ms()
                self._tell_state(seconds_since(self._told_at) > STATE_EVERY_S)
        finally:
            for task in tasks:
                task.cancel()

    def _up(self):
        self.duties.entrance.came_in()
        self.duties.connected = True
        if self.duties.work is None:
            self.panel.show("VIPO online", self.client.client_id)
        self.duties.shine()
        self._describe()

    def _down(self, reason):
        if self.duties.work is None:
            self.panel.show("No connection", reason)
        self.duties.connected = False
        self.duties.shine()

    def _describe(self):
        self.client.publish(self.base + "up/desc", self.description, retain=True, replace=True)
        self.client.publish(self.base + "up/presence", self._presence("online"), retain=True, replace=True)
        self._tell_state(True)

    def _presence(self, word):
        return json.dumps({"s": word, "boot": self.boot}).encode()

    def _tell_state(self, even_if_equal):
        """Publish the state when it changed, or when it must be repeated."""
        work = self.duties.work
        state = {
            "boot": self.boot,
            "done": work is None,
            "cmd": work.command if work else "",
            "props": dict(self.duties.driver.properties),
        }
        if not self.client.connected or (state == self._told and not even_if_equal):
            return
        self._told, self._told_at = state, ticks_ms()
        self.sequence += 1
        message = dict(state)
        message["seq"] = self.sequence
        self.client.publish(self.base + "up/state", json.dumps(message).encode(), retain=True, replace=True)

    def _heard(self, topic, payload, retained, whole):
        """Take in a message; one that is not whole was too long, and its payload is only the beginning."""
        if topic == "vipo/v1/srv/status":
            if not retained:
                self._describe()
        elif topic.endswith("/stop") and topic.startswith("vipo/v1/site/"):
            self.duties.stop(topic, payload if whole else None)
        elif topic.startswith(self.base + "down/") and not retained:
            self.duties.told(topic[len(self.base) + 5 :], payload, whole)
