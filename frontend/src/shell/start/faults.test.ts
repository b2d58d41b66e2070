import { expect, test } from "vitest";
import type { Device } from "@/api/types";
import { conditionsOf } from "./conditions";
import {
  beginningsOf,
  devicesFor,
  draftOf,
  entryOf,
  FAULT_WORDS,
  type FaultDraft,
  freshFault,
  problemsOf,
} from "./faults";

const device = (id: string, kind: string, properties: { name: string; type: string; unit?: string }[]) =>
  ({ id, name: id, kind, lifecycle: "approved", properties }) as unknown as Device;
const oven = device("oven", "machine", [
  { name: "temperature", type: "number" },
  { name: "quality", type: "string" },
]);
const robot = device("robot", "robot", [{ name: "battery", type: "number", unit: "PERCENT" }]);
const plain = device("plain", "robot", []);
const away = { ...oven, id: "away", lifecycle: "pending" } as Device;
const around = { devices: [oven, robot, plain, away], steps: new Set(["a"]) };
const fault = (changes: Partial<FaultDraft>): FaultDraft => ({ ...freshFault(), device: "oven", ...changes });
const wrong = (changes: Partial<FaultDraft>) =>
  Object.entries(problemsOf(fault(changes), around)).map(([field, { why }]) => `${field}: ${why}`);

test("a fault that is filled in has no problems, and is told with what its kind takes alone", () => {
  expect(wrong({})).toEqual([]);
  expect(entryOf(fault({ error: "not said of late answers", property: "temperature" }))).toEqual({
    fault: "late",
    device: "oven",
    after_s: 10,
  });
  expect(entryOf(fault({ fault: "fails", begins: "step", at_step: "a", error: " Too hot. " }))).toEqual({
    fault: "fails",
    device: "oven",
    at_step: "a",
    nth: 1,
    error: "Too hot.",
  });
  expect(entryOf(fault({ fault: "obstacle", numbers: { x: 1, y: 2, size_m: 0.5, at_s: 5 }, begins: "at" }))).toEqual({
    fault: "obstacle",
    x: 1,
    y: 2,
    size_m: 0.5,
    at_s: 5,
  });
});

test("what is missing, gone or out of range is told at its field", () => {
  expect(wrong({ device: null })).toEqual(["device: choose"]);
  expect(wrong({ device: "away" })).toEqual(["device: gone"]);
  expect(wrong({ fault: "battery", device: "plain" })).toEqual(["device: gone"]);
  expect(wrong({ begins: "step" })).toEqual(["at_step: choose"]);
  expect(wrong({ begins: "step", at_step: "b", numbers: { nth: 1.5, after_s: 1 } })).toEqual([
    "at_step: gone",
    "nth: number",
  ]);
  expect(wrong({ begins: "at", numbers: { at_s: -1, after_s: 0 } })).toEqual(["at_s: number", "after_s: number"]);
  expect(wrong({ fault: "obstacle", numbers: { x: 1 } })).toEqual(["y: number"]);
});

test("what lasts and comes by chance has to end; what lies on the floor does not come by chance", () => {
  expect(wrong({ begins: "chance" })).toEqual(["for_s: needs_end"]);
  expect(wrong({ begins: "chance", numbers: { odds: 0.1, for_s: 5, after_s: 1 } })).toEqual([]);
  expect(wrong({ fault: "fails", begins: "chance" })).toEqual([]);
  expect(beginningsOf("obstacle")).toEqual(["now", "at", "step"]);
});

test("a wrong value fits its reading", () => {
  const shows = (property: string | null, value: FaultDraft["value"]) =>
    wrong({ fault: "wrong_value", property, value });
  expect([shows(null, 1), shows("gone", 1), shows("temperature", null)]).toEqual([
    ["property: choose"],
    ["property: gone"],
    ["value: choose"],
  ]);
  expect([shows("temperature", "hot"), shows("temperature", 0), shows("quality", "ok")]).toEqual([
    ["value: misfit"],
    [],
    [],
  ]);
});

test("only robots drop things, and only those that tell of a battery can run low", () => {
  const ids = (word: FaultDraft["fault"]) => devicesFor(word, around.devices).map(({ id }) => id);
  expect([ids("drops"), ids("battery"), ids("wrong_value"), ids("dead")]).toEqual([
    ["robot", "plain"],
    ["robot"],
    ["oven", "robot"],
    ["oven", "robot", "plain"],
  ]);
});

test("a battery that is told in volts, in words or by yes or no says nothing of how full it is", () => {
  const robots = [
    device("share", "robot", [{ name: "battery", type: "number", unit: "" }]),
    device("volts", "robot", [{ name: "battery", type: "number", unit: "V" }]),
    device("words", "robot", [{ name: "battery", type: "text", unit: "" }]),
    device("truth", "robot", [{ name: "battery", type: "boolean", unit: "" }]),
  ];
  expect(devicesFor("battery", robots).map(({ id }) => id)).toEqual(["share"]);
});

test("what the server tells of a fault is a form again, and the same when it is sent", () => {
  const told = [
    { fault: "late", device: "oven", after_s: 4, odds: 0.25, for_s: 10 },
    { fault: "wrong_value", device: "oven", property: "temperature", value: -40, at_s: 3 },
    { fault: "obstacle", x: 1, y: 2, size_m: 0.5, at_s: 9, for_s: 30 },
    { fault: "fails", device: "oven", error: "Too hot.", at_step: "a", nth: 2 },
  ];
  expect(told.map((entry) => draftOf(entry)).map((draft) => draft && entryOf(draft))).toEqual(told);
  expect([draftOf({ fault: "explodes" }), draftOf("late"), draftOf(null)]).toEqual([null, null, null]);
  expect(FAULT_WORDS).toHaveLength(12);
});

test("conditions that cannot be read are the usual ones", () => {
  const usual = { seed: 0, driver: "physics", parameters: {}, faults: [] };
  expect([conditionsOf(null), conditionsOf("x"), conditionsOf({ seed: -1, driver: "magic", faults: 3 })]).toEqual([
    usual,
    usual,
    usual,
  ]);
});
