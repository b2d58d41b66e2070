import { expect, test } from "vitest";
import type { SiteDevice } from "@/program/surroundings";
import { askOf, finish, RESTING, stepBack, suggestedLoads, suits, takeTool, withDevice } from "./tool";

function machine(id: string, gives: string[], takes: string[]): SiteDevice {
  return {
    id,
    name: id,
    kind: "machine",
    device_class: "shelf",
    status: "idle",
    doing: "",
    location: { x: 0, y: 0, theta: 0 },
    size: null,
    properties: [],
    methods: [],
    gives,
    takes,
  };
}

const shelf = machine("shelf", ["box"], []);
const oven = machine("oven", ["box"], ["box"]);
const cans = machine("cans", ["can"], []);

test("a pick-and-drop asks for source, target and load in turn", () => {
  const first = takeTool(RESTING, "pick_and_drop", false);
  expect(askOf(first)).toBe("source");
  const second = withDevice(first, "shelf");
  expect(askOf(second)).toBe("target");
  expect(askOf(withDevice(second, "oven"))).toBe("load");
});

test("going back undoes one press at a time", () => {
  const full = withDevice(withDevice(takeTool(RESTING, "pick_and_drop", false), "shelf"), "oven");
  expect(stepBack(full).target).toBeNull();
  expect(stepBack(stepBack(full)).source).toBeNull();
  expect(stepBack(stepBack(stepBack(full)))).toEqual(RESTING);
});

test("the source cannot be the target too", () => {
  const gesture = withDevice(takeTool(RESTING, "pick_and_drop", false), "oven");
  expect(withDevice(gesture, "oven").target).toBeNull();
  expect(suits(gesture, oven, oven)).toBe(false);
});

test("only devices that give and take the object suit", () => {
  const start = takeTool(RESTING, "pick_and_drop", false);
  expect(suits(start, shelf, undefined)).toBe(true);
  expect(suits(withDevice(start, "cans"), oven, cans)).toBe(false);
  expect(suits(withDevice(start, "shelf"), oven, shelf)).toBe(true);
});

test("a tool taken twice stays in hand", () => {
  const once = takeTool(RESTING, "move", false);
  expect(finish(once)).toEqual(RESTING);
  expect(finish(takeTool(once, "move", false)).tool).toBe("move");
});

test("the likeliest loads are offered", () => {
  expect(suggestedLoads(shelf, oven, 2)).toEqual([
    { quantity: 1, object: "box" },
    { quantity: 2, object: "box" },
  ]);
  expect(suggestedLoads(undefined, undefined, 2)).toEqual([]);
});

test("an Operate takes a robot that describes a method of its own, and no other tool takes a robot", () => {
  const named = (name: string) => ({ name, parameters: [] });
  const robot = (...names: string[]): SiteDevice => ({ ...oven, kind: "robot", methods: names.map(named) });
  const operate = takeTool(RESTING, "operate", false);
  expect(suits(operate, robot("move", "honk"), undefined)).toBe(true);
  expect(suits(operate, robot("move", "pick", "drop"), undefined)).toBe(false);
  expect(suits(takeTool(RESTING, "move", false), robot("move", "honk"), undefined)).toBe(false);
  expect(suits(takeTool(RESTING, "pick_and_drop", false), robot("honk"), undefined)).toBe(false);
});
