import { expect, test } from "vitest";
import { scriptWith } from "./pastedScript";
import { codeOf, inCode, methodsOf } from "./pieces";
import { partsOf } from "./scriptParts";

/** Numbers that look like chance and are the same each time. */
function chanceOf(seed: number): <T>(from: readonly T[]) => T {
  let state = seed * 2654435761 + 1;
  return (from) => {
    state = (Math.imul(state ^ (state >>> 15), 2246822519) + 3266489917) >>> 0;
    return from[(state >>> 8) % from.length] as (typeof from)[number];
  };
}

type Pick = ReturnType<typeof chanceOf>;

const ROBOTS = ['ctx.get("robot01")', 'ctx.get("robot02")', "ctx.any()", 'ctx.any("move")'];
const CHOSEN = "ctx.any(where=lambda robot: robot.battery > 30)";
const MACHINES = [
  'ctx.get("curingOven01")',
  'ctx.get("paintMachine01")',
  'ctx.parameter("NAME", "curingOven01", Device)',
];
const ZONES = [
  'ctx.zone("z1", [(0, 0), (1, 0), (1, 1)], rule="slow", speed=0.3, name="Ramp")',
  'ctx.zone("z1", [(0, 0), (1, 0), (1, 1)], rule="slow", speed=0.3, name="Wet")',
  'ctx.zone("z1", [(0, 0), (2, 0), (1, 1)], rule="slow", speed=0.3, name="Ramp")',
  'ctx.zone("z2", [(0, 0), (2, 0), (2, 2)], rule="keep out")',
];
const VALUES = [
  'ctx.parameter("NAME", 2, Number)',
  'ctx.parameter("NAME", 5, Number)',
  'ctx.parameter("NAME", "2", Text)',
];
const POOLS = {
  robot: ROBOTS,
  carrier: [...ROBOTS, CHOSEN],
  spot: MACHINES,
  oven: MACHINES,
  ramp: ZONES,
  wet: ZONES,
  rounds: VALUES,
};

function stepOf(pick: Pick, calls: readonly string[]): string[] {
  const robot = pick(["robot", "carrier"]);
  return pick([
    [`self.${robot}.move(self.${pick(["spot", "oven"])}.location)`],
    [`if self.${robot} in self.${pick(["ramp", "wet"])}:`, "    self.wait(1)"],
    [`self.notify(f"self.robot at {self.rounds} {{self.oven}}", level="info")`],
    [`self.${robot}.move((${pick([1, 2])}, ${pick([1, 2])}))`],
    ...calls.map((name) => [`self.${name}()`]),
    ...(calls.length > 2 ? [["PARALLEL"]] : []),
  ]);
}

/** A program whose functions call each other downwards, with a Parallel here and there. */
function programOf(pick: Pick): string {
  const methods: string[] = [];
  let branches = 0;
  const bodyOf = (calls: readonly string[]): string[] =>
    [0, 1].flatMap(() => {
      const step = stepOf(pick, calls);
      if (step[0] !== "PARALLEL") return step;
      branches += 1;
      const names = ["a", "b"].map((letter) => `branch_${branches}${letter}`);
      for (const name of names) methods.push(methodOf(name, stepOf(pick, calls.slice(0, 2))));
      return [`self.parallel(${names.map((name) => `self.${name}`).join(", ")})`];
    });
  const body = bodyOf(["serve", "rest", "clean"]);
  const functions = [["clean"], ["rest", "clean"], ["serve", "rest", "clean"]].map(([name = "", ...calls]) =>
    methodOf(name, [...stepOf(pick, calls), ...stepOf(pick, calls)]),
  );
  const all = [...functions, ...methods];
  const used = codeOf([...body, ...all].join("\n"));
  const given = Object.entries(POOLS).flatMap(([name, pool]) =>
    new RegExp(`self\\.${name}\\b`).test(used) || /\{self/.test(all.join("")) ? [`self.${name} = ${pick(pool)}`] : [],
  );
  const drawn = new Set<string>();
  const once = given.filter((line) => {
    const zone = /ctx\.zone\("(\w+)"/.exec(line)?.[1];
    return zone === undefined || (!drawn.has(zone) && drawn.add(zone));
  });
  const known = new Set(once.map((line) => /self\.(\w+)/.exec(line)?.[1]));
  const missing = ["ramp", "wet"].filter((name) => used.includes(`self.${name}`) && !known.has(name));
  const [same = "z1"] = drawn;
  const named = missing.map((name) => `self.${name} = ${drawn.size > 0 ? `ctx.zone("${same}")` : ZONES[0]}`);
  const run = [...once, ...named].map((line) => line.replace("NAME", /self\.(\w+)/.exec(line)?.[1] ?? ""));
  return `class Task(object):\n${methodOf("new_task", body)}\n${all.map((each) => `${each}\n`).join("")}${methodOf("run", [...run, "self.new_task()"], "self, ctx")}`;
}

function methodOf(name: string, lines: readonly string[], takes = "self"): string {
  return `    def ${name}(${takes}):\n${lines.map((line) => `        ${line}\n`).join("")}`;
}

/** What is done, line for line through all calls, with what names stand for in place of the names. */
function doneBy(script: string): string[] {
  const { methods, given } = partsOf(script);
  const linesOf = (name: string): string[] =>
    (methods.get(name) ?? []).slice(1).flatMap((line) => {
      const called = [...codeOf(line).matchAll(/self\.(\w+)/g)]
        .map(([, each = ""]) => each)
        .filter((each) => methods.has(each));
      return called.length > 0 ? called.flatMap(linesOf) : [line.trim()];
    });
  const meaning = (name: string) => {
    const what = given.get(name)?.what ?? name;
    if (what.startsWith("ctx.parameter")) return `<parameter ${/\w+\)$/.exec(what)?.[0]}`;
    // A zone that is only named is the one that is drawn under that id.
    const zone = [...given.values()].find((each) => what === `ctx.zone("${each.id}")` && each.what.includes("["));
    return `<${(zone?.what ?? what).replace(/"z\d\w*"|, name="\w+"/g, "")}>`;
  };
  return linesOf("new_task").map((line) =>
    inCode(line, (code) => code.replace(/self\.(?!wait|notify)(\w+)/g, (_, name: string) => meaning(name))),
  );
}

/** Any robot may be one that the program names. */
function isDone(wanted: string, done: string): boolean {
  if (wanted === done) return true;
  const text = wanted.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
  return new RegExp(`^${text.replaceAll(/<ctx\\.any\\\((?:"move")?\\\)>/g, "<ctx\\.(?:any|get)\\(.*?\\)>")}$`).test(
    done,
  );
}

test("pasted steps name what they named, and the program's own steps go on as they were", () => {
  for (let seed = 1; seed <= 150; seed += 1) {
    const pick = chanceOf(seed);
    const [ours, theirs] = [programOf(pick), programOf(pick)];
    const text = scriptWith(theirs, { script: ours, lines: [] }, null, []) ?? "";
    const twice = scriptWith(theirs, { script: text, lines: [] }, null, []) ?? "";
    const [own, wanted] = [doneBy(ours), doneBy(theirs)];
    const why = `${seed}\n${ours}\n${theirs}\n${text}`;
    expect(doneBy(text).slice(0, own.length), why).toEqual(own);
    const pasted = doneBy(text).slice(own.length);
    expect(pasted.length, why).toBe(wanted.length);
    wanted.forEach((line, at) => expect(isDone(line, pasted[at] ?? ""), `${line}\n${pasted[at]}\n${why}`).toBe(true));
    expect(doneBy(twice), why).toEqual([...own, ...pasted, ...pasted]);
    // What the first paste brought is not brought again, but for branches, of which each Parallel has its own.
    const given = (script: string) => [...partsOf(script).given.keys()];
    expect(given(twice), why).toEqual(given(text));
    const functions = (script: string) => [...methodsOf(script).keys()].filter((name) => !name.startsWith("branch"));
    expect(functions(twice), why).toEqual(functions(text));
  }
});
