import { expect, test } from "vitest";
import type { Step } from "@/program/document/document";
import type { SiteDevice } from "@/program/surroundings";
import type { Edit } from "./edits";
import { canAll, matchesFor, strangersIn, withChosen } from "./holes";

const step = (id: string, kind: Step["kind"], params: Step["params"]): Edit => ({
  do: "add_step",
  id,
  step: { kind, pos: [0, 0], place: null, params },
});
const EDITS: readonly Edit[] = [
  { do: "set_role", id: "r", value: { name: "Robot", device: "turtle9" } },
  step("cure", "operate", { device: { device: "oven9" }, method: "cure", args: { beside: { device: "lamp9" } } }),
  step("read", "wait", { until: { op: ">", args: [{ property: ["oven9", "temperature"] }, 40] }, timeout: 9 }),
  step("carry", "pick_and_drop", {
    role: "r",
    source: { device: "oven9" },
    target: { device: "here" },
    object: "box",
  }),
  step("each", "for_each", { variable: "v", items: [{ device: "oven9" }, { device: "here" }] }),
  step("go", "move", { role: "r", to: { place: "dock9" } }),
];
const KNOWN = { devices: new Set(["here"]), places: new Set<string>(), names: { oven9: "Old Oven" } };

function device(id: string, more: Partial<SiteDevice> = {}): SiteDevice {
  const own = {
    id,
    name: id,
    kind: "machine",
    device_class: "machine",
    methods: [],
    properties: [],
    gives: [],
    takes: [],
  };
  return { ...own, ...more } as unknown as SiteDevice;
}

test("what is not known here is found, with its name from there and what the steps want of it", () => {
  const [turtle, oven, ...rest] = strangersIn(EDITS, KNOWN);
  expect([turtle?.id, turtle?.needs.robot]).toEqual(["turtle9", true]);
  expect(oven).toEqual({
    kind: "device",
    id: "oven9",
    name: "Old Oven",
    needs: { robot: false, methods: ["cure"], gives: ["box"], takes: [], readings: ["temperature"] },
  });
  expect(rest.map(({ kind, id }) => [kind, id])).toEqual([
    ["device", "lamp9"],
    ["place", "dock9"],
  ]);
  expect(
    strangersIn(EDITS, {
      ...KNOWN,
      devices: new Set(["here", "oven9", "lamp9", "turtle9"]),
      places: new Set(["dock9"]),
    }),
  ).toEqual([]);
});

test("who can all that is wanted comes first, then who is called alike; robots stand in for robots", () => {
  const cures = [{ name: "cure", parameters: [] }];
  const reads = [{ name: "temperature", value: 20 }];
  const fits = device("kiln", { methods: cures, properties: reads, gives: ["box"] });
  const alike = device("oven2", { methods: cures });
  const robot = device("turtle1", { kind: "robot" });
  const [turtle, oven] = strangersIn(EDITS, KNOWN);
  if (!turtle || !oven) throw new Error("no strangers");
  expect(matchesFor(oven, [device("sink"), alike, robot, fits]).map(({ id }) => id)).toEqual(["kiln", "oven2", "sink"]);
  expect([canAll(fits, oven.needs), canAll(alike, oven.needs)]).toEqual([true, false]);
  expect(matchesFor(turtle, [fits, robot]).map(({ id }) => id)).toEqual(["turtle1"]);
});

function params(edits: readonly Edit[], id: string): unknown {
  const found = edits.find((edit) => edit.do === "add_step" && edit.id === id);
  return found?.do === "add_step" ? found.step.params : null;
}

test("what was chosen stands in everywhere: in fields, arguments, readings, lists and roles", () => {
  const chosen = new Map([
    ["oven9", "kiln"],
    ["turtle9", "turtle1"],
    ["lamp9", "lamp"],
    ["dock9", "dock"],
  ]);
  const put = withChosen(EDITS, chosen);
  expect(JSON.stringify(put)).not.toContain('9"');
  expect(params(put, "read")).toEqual({
    until: { op: ">", args: [{ property: ["kiln", "temperature"] }, 40] },
    timeout: 9,
  });
  expect(put[0]).toEqual({ do: "set_role", id: "r", value: { name: "Robot", device: "turtle1" } });
});

test("what is left open is a hole: a field without a value, a condition as a whole, a list without that item", () => {
  const put = withChosen(
    EDITS,
    new Map([
      ["oven9", null],
      ["turtle9", null],
      ["lamp9", null],
      ["dock9", null],
    ]),
  );
  expect(params(put, "cure")).toEqual({ method: "cure", args: {} });
  expect(params(put, "read")).toEqual({ timeout: 9 });
  expect(params(put, "carry")).toEqual({ role: "r", target: { device: "here" }, object: "box" });
  expect(params(put, "each")).toEqual({ variable: "v", items: [{ device: "here" }] });
  expect(put[0]).toEqual({ do: "set_role", id: "r", value: { name: "Robot" } });
});

test("the device that opens a passage is asked for, and left open it is left out", () => {
  const open = { name: "Gate", rule: "door" as const, points: [] };
  const zone = { ...open, door: "gate9" };
  const edits: readonly Edit[] = [{ do: "set_zone", id: "z", value: zone }];
  const [gate] = strangersIn(edits, KNOWN);
  expect([gate?.id, gate?.needs.methods]).toEqual(["gate9", ["open"]]);
  expect(withChosen(edits, new Map([["gate9", "gate"]]))).toEqual([
    { do: "set_zone", id: "z", value: { ...zone, door: "gate" } },
  ]);
  expect(withChosen(edits, new Map([["gate9", null]]))).toEqual([{ do: "set_zone", id: "z", value: open }]);
});
