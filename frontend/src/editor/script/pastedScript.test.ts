import { expect, test } from "vitest";
import type { NamedDevice } from "./completion";
import { scriptWith } from "./pastedScript";
import { looksLikeScript } from "./scriptLines";

const OVEN: NamedDevice = { id: "curingOven01", name: "Curing Oven", kind: "machine", methods: [], properties: [] };
const PRINTED = {
  script: `class Task(object):
    def new_task(self):
        if self.curing_oven.temperature > 60:
            self.wait(1)
        else:
            self.wait(2)
        self.wait(3)

    def run(self, ctx):
        self.curing_oven = ctx.get("curingOven01")
        self.new_task()
`,
  lines: ["", "", "if", "w1", "if", "w2", "w3", "", "", "", "", ""],
};
const EMPTY = {
  script:
    "class Task(object):\n    def new_task(self):\n        pass\n\n    def run(self, ctx):\n        self.new_task()\n",
  lines: [],
};

test("only what begins like script is taken for it", () => {
  expect(["self.wait(5)", "\n    if a > 1:\n", "class Task(object):"].map(looksLikeScript)).toEqual([true, true, true]);
  expect(["Buy milk", "{}", "", "vipo"].map(looksLikeScript)).toEqual([false, false, false, false]);
});

test("lines go to the end of the program, indented as they must be", () => {
  const text = scriptWith("  self.wait(7)\n  while True:\n    self.wait(8)\n", PRINTED, null, [])?.split("\n");
  expect(text?.slice(6, 11)).toEqual([
    "        self.wait(3)",
    "        self.wait(7)",
    "        while True:",
    "          self.wait(8)",
    "",
  ]);
});

test("lines go behind the selected step and what stands in it", () => {
  expect(scriptWith("self.wait(7)", PRINTED, "if", [])?.split("\n")[6]).toBe("        self.wait(7)");
  expect(scriptWith("self.wait(7)", PRINTED, "w1", [])?.split("\n")[4]).toBe("            self.wait(7)");
});

test("devices and robots that the program does not have yet are given in run", () => {
  const pasted = "self.robot.move(self.curing_oven.location)\nself.mix_paint(3)";
  expect(scriptWith(pasted, EMPTY, null, [OVEN])?.split("\n").slice(1)).toEqual([
    "    def new_task(self):",
    "        self.robot.move(self.curing_oven.location)",
    "        self.mix_paint(3)",
    "",
    "    def run(self, ctx):",
    "        self.robot = ctx.any()",
    '        self.curing_oven = ctx.get("curingOven01")',
    "        self.new_task()",
    "",
  ]);
});

test("of a whole script the steps are taken, with what its run gives them", () => {
  const text = scriptWith(PRINTED.script.replace("curingOven01", "oven02"), EMPTY, null, [OVEN]);
  expect(text).toBe(PRINTED.script.replace("curingOven01", "oven02"));
});

test("a name that the program gives to another device is another one in what is pasted", () => {
  const pasted = PRINTED.script.replace("curingOven01", "oven02");
  const text = scriptWith(pasted, PRINTED, "w3", [OVEN])?.split("\n");
  expect(text?.filter((line) => /curing_oven/.test(line))).toEqual([
    "        if self.curing_oven.temperature > 60:",
    "        if self.curing_oven_2.temperature > 60:",
    '        self.curing_oven = ctx.get("curingOven01")',
    '        self.curing_oven_2 = ctx.get("oven02")',
  ]);
  expect(scriptWith(pasted, { ...PRINTED, script: text?.join("\n") ?? "" }, null, [OVEN])).not.toMatch(/oven_3/);
});

test("a name of the same device, of any robot or of a parameter is the program's own, however it is written", () => {
  const given = [
    'self.curing_oven = ctx.get("curingOven01")',
    'self.robot = ctx.get("robot02")',
    'self.rounds = ctx.parameter("rounds", 5, Number)',
    'self.ramp = ctx.zone("z1", [(0, 0), (1, 0), (1, 1)])',
  ];
  const run = (lines: readonly string[]) =>
    PRINTED.script.replace(/ +self\.curing_oven = .*\n/, lines.map((line) => `        ${line}\n`).join(""));
  const theirs = [
    "self.curing_oven = ctx.get('curingOven01')  # the (old) oven",
    "self.robot = ctx.any()",
    'self.rounds = ctx.parameter("rounds", 2, Number)',
    'self.ramp = ctx.zone("z1", [(0, 0), (2, 0), (1, 1)])',
  ];
  const body = "        self.robot.move(self.ramp)\n        self.wait(self.rounds)\n        if self.curing_oven";
  const text = scriptWith(
    run(theirs).replace("        if self.curing_oven", body),
    { ...PRINTED, script: run(given) },
    null,
    [OVEN],
  );
  expect(text).not.toMatch(/_2/);
  expect(text).toContain("self.robot.move(self.ramp)");
});

test("an empty text is nothing to paste", () => {
  expect(scriptWith(" \n", EMPTY, null, [])).toBeNull();
});

test("names of every language are taken for script, and given to what is not known yet", () => {
  expect(looksLikeScript("self.öfen_lüften(3)")).toBe(true);
  const oven = { ...OVEN, id: "ofen1", name: "Ofen Süd" };
  const text = scriptWith("self.ofen_süd.lüften(3)\nself.träger.move((1, 2))", EMPTY, null, [oven])?.split("\n");
  expect(text).toContain('        self.ofen_süd = ctx.get("ofen1")');
  expect(text).toContain("        self.träger = ctx.any()");
});
