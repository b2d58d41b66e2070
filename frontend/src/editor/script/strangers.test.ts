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
  const found = strangersInScript(SCRIPT, new Set(["oven"]));
  expect(found.map(({ id, needs }) => [id, needs.robot, needs.methods, needs.readings])).toEqual([
    ["turtle9", true, ["move"], []],
    ["oldKiln07", false, ["cure_paint"], ["temperature"]],
    ["lamp99", false, ["glow"], []],
  ]);
  expect(strangersInScript("self.wait(5)", new Set())).toEqual([]);
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
  const [found] = strangersInScript(script, new Set());
  expect([found?.id, found?.needs.methods, found?.needs.readings]).toEqual(["ofen9", ["lüften"], ["füllstand"]]);
  const open = scriptWithChosen(script, new Map([["ofen9", null]]));
  expect(open).toContain('self.öfen_süd.operate("lüften", {})');
});
