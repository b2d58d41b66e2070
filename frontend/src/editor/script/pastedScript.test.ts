import { expect, test, vi } from "vitest";
import { api } from "@/api/client";
import { EMPTY_DOCUMENT, type Step } from "@/program/document/document";
import type { OpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import type { NamedDevice } from "./completion";
import { drawPasted, scriptWith } from "./pastedScript";
import { tidied } from "./pieces";
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

test("with all selected, lines go behind the last step of the program and into no function", async () => {
  const post = vi.spyOn(api, "post").mockResolvedValue({ document: null, lines: [], diagnostics: [] });
  const script = taskOf(["self.wait(1)", "self.mix()"], [], "mix(self):\nself.wait(2)");
  const lines = script.split("\n").map((line) => /mix\(\)|\d/.exec(line)?.[0] ?? "");
  const step = (kind: string, parent: string, order: string): Step => {
    return { kind, place: [parent, "body", order], pos: [1, 1], params: kind === "call" ? { function: "mix" } : {} };
  };
  const steps = { 1: step("wait", "program", "A"), "mix()": step("call", "program", "B"), 2: step("wait", "mix", "A") };
  const document = { ...EMPTY_DOCUMENT, functions: { mix: { name: "mix", parameters: [] } }, steps };
  useUi.setState({ selected: ["1", "mix()", "2"] });
  const open = {
    compiled: { script, lines },
    shared: { getDocument: () => document },
    program: { id: "p" },
    devices: [],
  };
  await drawPasted({ ...open, t: String } as unknown as OpenProgram, "self.wait(7)", new Map());
  const [[, asked]] = post.mock.calls as [[string, { text: string }]];
  expect(asked.text.split("\n").slice(2, 5)).toEqual([
    "        self.wait(1)",
    "        self.mix()",
    "        self.wait(7)",
  ]);
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

/** A task whose run gives what stands in `given`. */
function taskOf(body: readonly string[], given: readonly string[], ...methods: readonly string[]): string {
  const lines = (all: readonly string[]) => all.map((line) => `        ${line}\n`).join("");
  const more = methods.map((method) => `    def ${method.replaceAll("\n", "\n        ")}\n\n`).join("");
  return `class Task(object):\n    def new_task(self):\n${lines(body)}\n${more}    def run(self, ctx):\n${lines(given)}        self.new_task()\n`;
}

/** The lines that a paste adds, and those that it changes. */
function added(theirs: string, ours: string, devices: readonly NamedDevice[] = []): string[] {
  const own = ours.split("\n");
  const text = scriptWith(theirs, { script: ours, lines: [] }, null, devices) ?? "";
  const left = [...own];
  const fresh = text.split("\n").filter((line) => {
    const at = left.indexOf(line);
    if (at < 0) return true;
    left.splice(at, 1);
    return false;
  });
  const said = fresh.filter((line) => line.trim()).map((line) => line.trim().replaceAll(/ +/g, " "));
  return [...said, ...left.map((line) => `lost: ${line}`)];
}

const RAMP = 'ctx.zone("z1", [(0, 0), (1, 0), (1, 1)], rule="slow", speed=0.3, name="Ramp")';

test("a name of the same device, of any robot or of a parameter is the program's own, however it is written", () => {
  const ours = taskOf(
    ["self.wait(9)"],
    [
      'self.curing_oven = ctx.get("curingOven01")',
      'self.robot = ctx.get("robot02")',
      'self.rounds = ctx.parameter("rounds", 5, Number("s"))',
      `self.ramp = ${RAMP}`,
    ],
  );
  const theirs = taskOf(
    ["self.robot.cover(self.ramp)", "self.wait(self.rounds)", "self.curing_oven.cure_paint(1)"],
    [
      "self.curing_oven = ctx.get('curingOven01')  # the (old) oven",
      "self.robot = ctx.any()",
      "self.rounds = ctx.parameter('rounds', 2, Number('s'))",
      "self.ramp = ctx.zone('z1', [(0, 0.0), (1,0),",
      "    (1, 1)], name='Ramp', rule='slow', speed=0.30)",
    ],
  );
  expect(added(theirs, ours)).toEqual([
    "self.robot.cover(self.ramp)",
    "self.wait(self.rounds)",
    "self.curing_oven.cure_paint(1)",
  ]);
});

test("a function whose lines differ comes under a name of its own, with what calls it", () => {
  const ours = taskOf(
    ["self.serve()", "self.clean()"],
    ['self.robot = ctx.get("robot02")'],
    "serve(self):\nself.robot.move((9, 9))",
    "clean(self):\nself.serve()",
    "rest(self):\nself.wait(5)",
  );
  const theirs = taskOf(
    ["self.clean()", "self.rest()"],
    ['self.robot = ctx.get("robot02")'],
    "clean(self):\nself.serve()",
    "serve(self):\nself.robot.move((1,1))  # home",
    "rest(self):\nself.wait( 5 )",
  );
  expect(added(theirs, ours)).toEqual([
    "self.clean_2()",
    "self.rest()",
    "def clean_2(self):",
    "self.serve_2()",
    "def serve_2(self):",
    "self.robot.move((1,1))",
  ]);
});

test("a function of the same lines that drives another robot is another function", () => {
  const serve = "serve(self):\nself.robot.move((1, 1))";
  const ours = taskOf(["self.serve()"], ['self.robot = ctx.get("robot02")'], serve);
  const theirs = taskOf(["self.serve()"], ['self.robot = ctx.get("robot01")'], serve);
  const lines = ["self.serve_2()", "def serve_2(self):", "self.robot_2.move((1, 1))"];
  expect(added(theirs, ours)).toEqual([...lines, 'self.robot_2 = ctx.get("robot01")']);
  expect(added(ours, ours)).toEqual(["self.serve()"]);
});

test("branches and events are brought with methods of their own", () => {
  const both = ["self.parallel(self.branch_1a, self.branch_1b)"];
  const branches = ["branch_1a(self):\nself.wait(1)", "branch_1b(self):\nself.wait(2)"];
  const run = ['self.robot = ctx.get("robot01")', "ctx.when(self.robot.battery < 9, self.when_e1)"];
  const ours = taskOf(both, run, ...branches, "when_e1(self):\nself.wait(3)");
  expect(added(ours, ours)).toEqual([
    "self.parallel(self.branch_1a_2, self.branch_1b_2)",
    ...["def branch_1a_2(self):", "self.wait(1)", "def branch_1b_2(self):", "self.wait(2)"],
    ...["def when_e1_2(self):", "self.wait(3)", "ctx.when(self.robot.battery < 9, self.when_e1_2)"],
  ]);
});

test("a function that the program has brings no branches with it", () => {
  const serve = (step: string) => [
    `serve(self):\nself.parallel(self.branch_${step}a, self.branch_${step}b)`,
    `branch_${step}a(self):\nself.wait(1)`,
    `branch_${step}b(self):\nself.wait(2)`,
  ];
  expect(added(taskOf(["self.serve()"], [], ...serve("1")), taskOf(["self.wait(1)"], [], ...serve("7")))).toEqual([
    "self.serve()",
  ]);
});

test("parameters are the program's own where they are of one type, and never one of its devices", () => {
  const ours = taskOf(
    ["self.wait(1)"],
    ['self.machine = ctx.get("curingOven01")', 'self.time = ctx.parameter("time", 2, Number("min"))'],
  );
  const theirs = taskOf(
    ['self.machine.operate("curePaint", {"time": 3})', "self.wait(self.time)"],
    [
      'self.machine = ctx.parameter("machine", "curingOven02", Device)',
      'self.time = ctx.parameter("time", 2, Number("s"))',
    ],
  );
  expect(added(theirs, ours)).toEqual([
    'self.machine_2.operate("curePaint", {"time": 3})',
    "self.wait(self.time_2)",
    'self.machine_2 = ctx.parameter("machine_2", "curingOven02", Device)',
    'self.time_2 = ctx.parameter("time_2", 2, Number("s"))',
  ]);
});

test("any robot is none of the program's machines, nor a robot that it chooses otherwise", () => {
  const theirs = taskOf(
    ["self.helper.move((1, 1))"],
    ["self.helper = ctx.any(where=lambda robot: robot.battery > 30)"],
  );
  const helped = (given: string) => added(theirs, taskOf(["self.wait(1)"], [`self.helper = ${given}`]), [OVEN])[0];
  expect(helped("ctx.any(where=lambda robot: robot.battery > 30)")).toBe("self.helper.move((1, 1))");
  expect(helped("ctx.any()")).toBe("self.helper_2.move((1, 1))");
  const plain = taskOf(["self.helper.move((1, 1))"], ["self.helper = ctx.any()"]);
  expect(added(plain, taskOf([], ['self.helper = ctx.get("curingOven01")']), [OVEN])[0]).toBe(
    "self.helper_2.move((1, 1))",
  );
  expect(added(plain, taskOf([], ['self.helper = ctx.get("robot02")']), [OVEN])[0]).toBe("self.helper.move((1, 1))");
});

test("a zone that the program calls otherwise is the same; one that it draws otherwise is another", () => {
  const theirs = taskOf(
    ["if self.robot in self.ramp:", "    self.wait(3)"],
    ["self.robot = ctx.any()", `self.ramp = ${RAMP}`],
  );
  const ours = (name: string, zone: string) =>
    taskOf(["self.wait(1)"], ["self.robot = ctx.any()", `self.${name} = ${zone}`]);
  expect(added(theirs, ours("wet", RAMP.replace("Ramp", "Wet")))).toEqual([
    "if self.robot in self.wet:",
    "self.wait(3)",
  ]);
  expect(added(theirs, ours("ramp", RAMP.replace("(1, 1)", "(2, 2)")))).toEqual([
    "if self.robot in self.ramp_2:",
    "self.wait(3)",
    `self.ramp_2 = ${RAMP.replace("z1", "z1_2")}`,
  ]);
});

test("texts stay as they are, but for what a message takes from the program", () => {
  const ours = taskOf(["self.robot.move((2, 2))"], ['self.robot = ctx.get("robot02")']);
  const told = [
    `self.notify("self.robot waits", level='info')`,
    `self.notify(f"self.robot {{self.robot}} {self.robot.battery}", level="info")`,
  ];
  expect(added(taskOf(told, ['self.robot = ctx.get("robot01")']), ours)).toEqual([
    told[0],
    `self.notify(f"self.robot {{self.robot}} {self.robot_2.battery}", level="info")`,
    'self.robot_2 = ctx.get("robot01")',
  ]);
  const alone = taskOf([told[0] ?? ""], ['self.robot = ctx.get("robot01")']);
  expect(added(alone, ours)).toEqual([told[0]]);
});

test("a device is no variable or function of the same name, and no function is a device", () => {
  const ours = taskOf(
    ["self.oven = 3", "self.wait(self.oven)"],
    ['self.lamp = ctx.get("lamp1")'],
    "door(self):\nself.wait(1)",
  );
  const theirs = taskOf(
    ["self.oven.heat(1)", "self.lamp()", "self.door = 2"],
    ['self.oven = ctx.get("oven2")'],
    "lamp(self):\nself.wait(2)",
  );
  expect(added(theirs, ours)).toEqual([
    ...["self.oven_2.heat(1)", "self.lamp_2()", "self.door_2 = 2"],
    ...["def lamp_2(self):", "self.wait(2)", 'self.oven_2 = ctx.get("oven2")'],
  ]);
});

test("script that is written by hand may indent and break its lines as Python lets it", () => {
  const theirs = `class Task(object):
\tdef new_task(self):
\t\tself.serve(
  1)

\tdef serve(self, times):  # twice
\t\tself.robot.move((1,
1))

\tdef run(self, ctx):
\t\tself.robot = ctx.get(
\t\t\t"robot01",  # the blue one
\t\t)
\t\tself.new_task()
`;
  const ours = taskOf(["self.wait(1)"], ['self.robot = ctx.get("robot02")'], "serve(self):\nself.robot.move((9, 9))");
  expect(added(theirs, ours)).toEqual([
    ...["self.serve_2( 1)", "def serve_2(self, times):", "self.robot_2.move((1, 1))"],
    'self.robot_2 = ctx.get( "robot01", )',
  ]);
});

test("a robot that begins at a machine is brought there before it picks: other steps may have moved it", () => {
  const pick = 'self.robot.pick({"value": 1, "object": "box"})';
  const run = ['self.robot = ctx.get("robot01", at="itemInventory01")'];
  const ours = taskOf(["self.robot.move((9, 9))"], ['self.robot = ctx.get("robot01")']);
  expect(added(taskOf([pick], run), ours)).toEqual([
    "self.robot.move(self.robot_stands.location)",
    pick,
    'self.robot_stands = ctx.get("itemInventory01")',
  ]);
  expect(added(taskOf(["self.robot.move((1, 1))"], run), ours)).toEqual(["self.robot.move((1, 1))"]);
});

test("a robot that begins at a machine is brought there, too, where a branch or a function picks first", () => {
  const run = ['self.robot = ctx.get("robot01", at="itemInventory01")'];
  const other = "branch_1b(self):\nself.wait(2)";
  const pick = 'self.robot.pick({"value": 1, "object": "box"})';
  const first = (line: string, ...methods: string[]) => added(taskOf([line], run, ...methods), EMPTY.script)[0];
  const parallel = "self.parallel(self.branch_1a, self.branch_1b)";
  const move = "self.robot.move(self.robot_stands.location)";
  expect(first(parallel, `branch_1a(self):\n${pick}`, other)).toBe(move);
  expect(first(parallel, "branch_1a(self):\nself.serve()", other, `serve(self):\nself.serve()\n${pick}`)).toBe(move);
  expect(first(parallel, `branch_1a(self):\nself.robot.move((1, 1))\n${pick}`, other)).toBe(parallel);
  expect(first("self.serve()", "serve(self):\nself.serve()")).toBe("self.serve()");
});

test("the first move stands in new_task also where run stands above it", () => {
  const run = 'def run(self, ctx):\n  self.robot = ctx.get("robot01", at="oven01")\n  self.new_task()\n';
  const text = scriptWith(`${run}def new_task(self):\n  self.robot.pick("box")\n`, EMPTY, null, [])?.split("\n");
  expect(text?.slice(2, 5)).toEqual([
    "        self.robot.move(self.robot_stands.location)",
    '        self.robot.pick("box")',
    "",
  ]);
});

test("script with very many spaces is read at once", () => {
  const spaces = " ".repeat(200_000);
  const serve = (gap: string) => `serve(self):\nwhile not${spaces}self.done:\n    self.wait(1 ${gap}+ 2)${gap}`;
  const pasted = taskOf(["self.serve()"], [], serve(spaces));
  expect(added(pasted, taskOf(["self.serve()"], [], serve(" ")))).toEqual(["self.serve()"]);
});

test("texts of several lines keep the spaces at the ends of theirs, and no other line does", () => {
  const text = '  self.log("""one  \ntwo  """)  # note\n  self.wait(7)  \n  self.wait(8)  ';
  expect(tidied(text)).toBe('  self.log("""one  \ntwo  """)\n  self.wait(7)\n  self.wait(8)');
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
