import { expect, test } from "vitest";
import { clippedScript } from "./clippedScript";
import { scriptWith } from "./pastedScript";
import { looksLikeScript } from "./scriptLines";

const PRINTED = {
  script: `class Task(object):
    def new_task(self):
        if self.curing_oven.temperature > 60:
            self.wait(1)
        else:
            self.tell("hot")
        self.robot.move(self.door.location)

    def tell(self, word):
        self.notify(word, level="info")

    def other(self):
        self.wait(9)

    def run(self, ctx):
        self.robot = ctx.any()
        self.curing_oven = ctx.get("curingOven01")
        self.door = ctx.place("door")
        self.new_task()
`,
  lines: ["", "", "if", "w1", "if", "call", "go", "", "", "say", "", "", "w9", "", "", "", "", "", "", ""],
};

test("selected steps are a small task with what stands in them, what they call and what run gives them", () => {
  expect(clippedScript(PRINTED, ["if"])?.split("\n")).toEqual([
    "class Task(object):",
    "    def new_task(self):",
    "        if self.curing_oven.temperature > 60:",
    "            self.wait(1)",
    "        else:",
    '            self.tell("hot")',
    "",
    "    def tell(self, word):",
    '        self.notify(word, level="info")',
    "",
    "    def run(self, ctx):",
    '        self.curing_oven = ctx.get("curingOven01")',
    "        self.new_task()",
    "",
  ]);
});

test("a step out of a branch begins at the margin", () => {
  const text = clippedScript(PRINTED, ["w1", "go"]);
  expect(text?.split("\n").slice(2, 4)).toEqual([
    "        self.wait(1)",
    "        self.robot.move(self.door.location)",
  ]);
  expect(text).not.toContain("def tell");
});

test("without its lines there is no script of a step", () => {
  expect(clippedScript(PRINTED, ["fresh"])).toBeNull();
  expect(clippedScript(PRINTED, [])).toBeNull();
});

test("what was copied is script that another program takes with its functions and names", () => {
  const empty =
    "class Task(object):\n    def new_task(self):\n        pass\n\n    def run(self, ctx):\n        self.new_task()\n";
  const text = clippedScript(PRINTED, ["if"]) ?? "";
  expect(looksLikeScript(text)).toBe(true);
  expect(scriptWith(text, { script: empty, lines: [] }, null, [])).toBe(text);
});

test("a function that the program has already is not brought twice", () => {
  const text = clippedScript(PRINTED, ["call"]) ?? "";
  const again = scriptWith(text, PRINTED, null, []) ?? "";
  expect(again.match(/def tell\(/g)?.length).toBe(1);
  expect(again.match(/self\.tell\("hot"\)/g)?.length).toBe(2);
});

test("what is called and given in other letters comes along", () => {
  const script = `class Task(object):
    def new_task(self):
        self.über_nacht()

    def über_nacht(self):
        self.öfen.lüften(3)

    def run(self, ctx):
        self.öfen = ctx.get("ofen1")
        self.new_task()
`;
  const text = clippedScript({ script, lines: ["", "", "call"] }, ["call"]);
  expect(text).toContain("    def über_nacht(self):\n        self.öfen.lüften(3)");
  expect(text).toContain('        self.öfen = ctx.get("ofen1")');
});

test("what is done at once is copied with its branches", () => {
  const script = `class Task(object):
    def new_task(self):
        self.parallel(self.branch_1a, self.branch_1b)

    def branch_1a(self):
        self.wait(1)

    def branch_1b(self):
        self.tell()

    def tell(self):
        self.robot.move((1, 1))

    def run(self, ctx):
        self.robot = ctx.any()
        self.new_task()
`;
  expect(clippedScript({ script, lines: ["", "", "at once"] }, ["at once"])).toBe(script);
});
