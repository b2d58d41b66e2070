import { expect, test } from "vitest";
import { scriptWithChosen, strangersInScript } from "./strangers";

const SCRIPT = `class Task(object):
    def new_task(self):
        self.old_kiln.cure_paint(7)
        if self.old_kiln.temperature > 40:
            self.robot.move(self.lamp.location)
        self.lamp.glow(1, True)

    def run(self, ctx):
        self.robot = ctx.get("turtle9")
        self.old_kiln = ctx.get("oldKiln07")
        self.lamp = ctx.get('lamp99')
        self.here = ctx.get("oven")
        self.new_task()
`;

test("devices that are got by an unknown id are strangers, with what the script does with them", () => {
  const found = strangersInScript(SCRIPT, new Set(["oven"]), new Set());
  expect(found.map(({ id, needs }) => [id, needs.robot, needs.methods, needs.readings])).toEqual([
    ["turtle9", true, ["move"], []],
    ["oldKiln07", false, ["cure_paint"], ["temperature"]],
    ["lamp99", false, ["glow"], []],
  ]);
  expect(strangersInScript("self.wait(5)", new Set(), new Set())).toEqual([]);
});

test("who was chosen stands in; what is left open is written so that it needs no description", () => {
  const text = scriptWithChosen(
    SCRIPT,
    new Map([
      ["oldKiln07", "curingOven01"],
      ["turtle9", "turtle1"],
      ["lamp99", null],
    ]),
  );
  expect(text).toContain('self.old_kiln = ctx.get("curingOven01")');
  expect(text).toContain('self.robot = ctx.get("turtle1")');
  expect(text).toContain('self.lamp.operate("glow", {})');
  expect(text).toContain("self.old_kiln.cure_paint(7)");
  expect(text).toContain("self.lamp = ctx.get('lamp99')");
});

test("strangers may have names of every language", () => {
  const script = 'self.öfen_süd.lüften(3)\nself.öfen_süd.füllstand\nself.öfen_süd = ctx.get("ofen9")';
  const [found] = strangersInScript(script, new Set(), new Set());
  expect([found?.id, found?.needs.methods, found?.needs.readings]).toEqual(["ofen9", ["lüften"], ["füllstand"]]);
  const open = scriptWithChosen(script, new Map([["ofen9", null]]));
  expect(open).toContain('self.öfen_süd.operate("lüften", {})');
});

test("devices and places are strangers wherever the script names them", () => {
  const script = `class Task(object):
    def new_task(self):
        self.robot.move(self.dock.location)
        self.notify('ctx.get("nobody")', level="info")
        self.machine.operate("curePaint", {})
        self.oven.read("wheel slip")

    def serve(self, oven: Device = "oven8", more: Number = 3):
        self.robot.move(oven.location)

    def run(self, ctx):
        self.robot = ctx.get("robot77", kind="robot")
        self.dock = ctx.place("dockX")
        self.machine = ctx.parameter("machine", "oven9", Device)
        self.ramp = ctx.zone("z1", [(0, 0), (1, 0), (1, 1)], rule="door", door="gate9", name="Ramp")
        self.oven = ctx.get("oven")
        self.new_task()
`;
  const found = strangersInScript(script, new Set(["oven"]), new Set(["oven9"]));
  expect(found.map(({ kind, id, needs }) => [kind, id, needs.robot, needs.methods])).toEqual([
    ["device", "oven8", false, []],
    ["device", "robot77", true, ["move"]],
    ["place", "dockX", false, []],
    ["device", "oven9", false, []],
    ["device", "gate9", false, ["open"]],
  ]);
  expect(strangersInScript(script, new Set(), new Set()).at(-1)?.needs.readings).toEqual(["wheel slip"]);
  const known = new Map(Object.entries({ robot77: "robot01", dockX: "dock1", oven9: "o1", gate9: "g1", oven8: null }));
  const text = scriptWithChosen(script, known);
  expect(text).toContain('self.robot = ctx.get("robot01", kind="robot")');
  expect(text).toContain('self.dock = ctx.place("dock1")');
  expect(text).toContain('ctx.parameter("machine", "o1", Device)');
  expect(text).toContain('rule="door", door="g1", name="Ramp")');
  expect(text).toContain("oven: Device = None, more: Number = 3");
});

test("an id is replaced where it is the id, whatever else is called so", () => {
  const script = 'self.lamp.glow(1)\nself.lamp = ctx.get("lamp")\nself.robot = ctx.get("robot", kind="robot")';
  expect(scriptWithChosen(script, new Map(Object.entries({ lamp: "l$&1", robot: "r1" })))).toBe(
    'self.lamp.glow(1)\nself.lamp = ctx.get("l$&1")\nself.robot = ctx.get("r1", kind="robot")',
  );
});

test("what is left open is read and driven without a description, and texts about it stay", () => {
  const script = `if self.kiln.temperature > 3 and self.kiln.read("wheel slip") > 2:
    self.notify(f"self.kiln.heat(1) {self.kiln.temperature}", level="info")
    self.robot.move(self.kiln.location)
    self.robot.honk(3)
    self.robot.release()
self.kiln = ctx.get("kiln9")
self.robot = ctx.get("robot9")`;
  expect(scriptWithChosen(script, new Map(Object.entries({ kiln9: null, robot9: null })))).toBe(
    `if self.kiln.read("temperature") > 3 and self.kiln.read("wheel slip") > 2:
    self.notify(f"self.kiln.heat(1) {self.kiln.read('temperature')}", level="info")
    self.robot.move(self.kiln.location)
    self.robot.operate("honk", {})
    self.robot.release()
self.kiln = ctx.get("kiln9")
self.robot = ctx.get("robot9")`,
  );
});
