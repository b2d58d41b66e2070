import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step, type Value } from "../document/document";
import { surroundingsOf, type SiteDevice } from "../surroundings";
import { chipText, plainText, valueText, type Speaker } from "./stepWords";

const OVEN = { id: "oven", name: "Curing Oven", kind: "machine", properties: [], methods: [] } as unknown as SiteDevice;
const DOCUMENT: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  functions: { mix: { name: "mixPaint", parameters: [{ name: "shade", type: "text" }], result: { type: "number" } } },
  roles: { robot: { name: "Carrier" } },
  zones: { z1: { name: "Aisle", rule: "slow", points: [] } },
};

/** Texts as their key, with what is filled in. */
const t = (key: string, values?: Record<string, unknown>) =>
  values ? `${key.replace(/^.*\./, "")}<${Object.values(values).join("|")}>` : key.replace(/^.*\./, "");
const speaker: Speaker = { document: DOCUMENT, surroundings: surroundingsOf([OVEN], []), t };

function say(kind: string, params: Step["params"]): string {
  return plainText(chipText({ kind, params }, speaker));
}

test.each<[string, Step["params"], string]>([
  ["repeat", { times: 3 }, "repeat 3 ×"],
  ["repeat", {}, "repeat ? ×"],
  ["for_each", { variable: "box", items: ["a", "b", "c"] }, "for_each<box> a, b +1"],
  ["for_each", { variable: "box", items: [] }, "for_each<box> ?"],
  ["set", { variable: "count", value: { op: "+", args: [{ param: "count" }, 1] } }, "count = count + 1"],
  ["set", {}, "? = ?"],
  ["ask", { question: "Is it dry?" }, "ask Is it dry?"],
  [
    "notify",
    { message: { op: "text", args: ["Painted ", { param: "count" }, " boxes"] } },
    "notify Painted count boxes",
  ],
  ["notify", { message: "A message that is longer than a chip" }, "notify A message that is longer…"],
  ["return", { value: 4 }, "return 4"],
  ["return", {}, "return"],
  ["break", {}, "break"],
  [
    "on_event",
    { condition: { op: ">", args: [{ property: ["oven", "temperature"] }, 80] } },
    "when Curing Oven temperature > 80",
  ],
  ["on_event", {}, "when ?"],
  ["wait", { duration: { quantity: [10, "MIN"] } }, "wait<10\u202fmin>"],
  ["call", { function: "mix", args: { shade: "teal" }, result: "total" }, "total = mixPaint (shade: teal)"],
])("a %s with %j reads %s", (kind, params, text) => {
  expect(say(kind, params)).toBe(text);
});

test.each<[Value, string]>([
  [{ at: { role: "robot" } }, "Carrier"],
  [{ op: "in", args: [{ at: { role: "robot" } }, { zone: "z1" }] }, "Carrier in Aisle"],
  [{ op: "*", args: [{ op: "+", args: [1, 2] }, 3] }, "(1 + 2) × 3"],
  [{ op: "-", args: [5, { op: "-", args: [3, 1] }] }, "5 − (3 − 1)"],
  [{ op: "and", args: [true, { op: "or", args: [false, true] }] }, "true and (false or true)"],
  [{ op: "not", args: [{ op: "==", args: [{ param: "x" }, 1] }] }, "not x = 1"],
  [
    { op: "distance", args: [{ at: { role: "robot" } }, { at: { device: "oven" } }] },
    "distance<Carrier|Curing Oven|Carrier, Curing Oven>",
  ],
  [["a", 2], "a, 2"],
])("the value %j reads %s", (value, text) => {
  expect(valueText(value, speaker)).toBe(text);
});

test("a colour has a swatch before its name", () => {
  expect(chipText({ kind: "set", params: { variable: "shade", value: "teal" } }, speaker)).toEqual([
    { text: "shade", tone: "plain" },
    { text: "=", tone: "plain" },
    { text: "teal", tone: "plain", swatch: "teal" },
  ]);
});

test("a comment says its first words, or that it waits for them", () => {
  expect(say("comment", { text: " Keep 2 cans? " })).toBe("Keep 2 cans?");
  expect(chipText({ kind: "comment", params: {} }, speaker)).toEqual([{ text: "comment", tone: "soft" }]);
});
