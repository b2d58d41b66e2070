import { expect, test } from "vitest";
import en from "@/i18n/en/editor.json";
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

/** The English texts, with what is filled in. */
function t(key: string, values: Record<string, unknown> = {}): string {
  const found = key.split(".").reduce<unknown>((texts, name) => (texts as Record<string, unknown>)[name], en);
  const other = typeof values.defaultValue === "string" ? values.defaultValue : key;
  const text = typeof found === "string" ? found : other;
  return text.replace(/\{\{(\w+)\}\}/g, (_, name: string) => String(values[name]));
}
const speaker: Speaker = { document: DOCUMENT, surroundings: surroundingsOf([OVEN], []), t };

function say(kind: string, params: Step["params"]): string {
  return plainText(chipText({ kind, params }, speaker));
}

test.each<[string, Step["params"], string]>([
  ["repeat", { times: 3 }, "repeat 3 ×"],
  ["repeat", {}, "repeat ? ×"],
  ["limit", { duration: { quantity: [5, "MIN"] } }, "At most 5\u202fmin"],
  ["limit", {}, "At most ?"],
  ["for_each", { variable: "box", items: ["a", "b", "c"] }, "each box in a, b +1"],
  ["for_each", { variable: "box", items: [] }, "each box in ?"],
  ["for_each", { variable: "box", items: ["a"], index: "number" }, "each box (number) in a"],
  ["set", { variable: "count", value: { op: "+", args: [{ param: "count" }, 1] } }, "count = count + 1"],
  ["for_each", { variable: "box", items: [], list: { param: "boxes" } }, "each box in boxes"],
  ["for_each", { variable: "box", items: ["a"], list: {} }, "each box in ?"],
  ["set", { variable: "all", value: { op: "list", args: [] } }, "all = empty list"],
  ["set", { variable: "one", value: { op: "nth", args: [{ param: "all" }, 2] } }, "one = item 2 of all"],
  ["set", {}, "? = ?"],
  ["ask", { question: "Is it dry?" }, "Ask Is it dry?"],
  ["fail", { message: "The box is wet" }, "Fail The box is wet"],
  ["cover", {}, "Cover ?"],
  ["cover", { zone: "gone" }, "Cover gone"],
  ["release", {}, "Release Carrier"],
  ["release", { role: "gone" }, "Release gone"],
  ["parallel", { branches: ["a", "b", "c"] }, "Parallel"],
  ["parallel", { branches: ["a", "b", "c"], needed: 1 }, "Parallel first of 3 ends it"],
  ["parallel", { branches: ["a", "b", "c"], needed: 2 }, "Parallel 2 of 3 end it"],
  ["parallel", { branches: ["a", "b", "c"], needed: 3 }, "Parallel"],
  ["parallel", { needed: 99 }, "Parallel 99 of 2 end it"],
  ["parallel", { needed: "x" }, "Parallel ? of 2 end it"],
  [
    "notify",
    { message: { op: "text", args: ["Painted ", { param: "count" }, " boxes"] } },
    "Notify Painted count boxes",
  ],
  ["notify", { message: "A message that is longer than a chip" }, "Notify A message that is longer…"],
  ["call", { function: "constructor" }, "?"],
  ["cover", { zone: "constructor" }, "Cover constructor"],
  ["return", { value: 4 }, "Return 4"],
  ["return", {}, "Return"],
  ["break", {}, "Leave the loop"],
  [
    "on_event",
    { condition: { op: ">", args: [{ property: ["oven", "temperature"] }, 80] } },
    "When Curing Oven temperature > 80",
  ],
  ["on_event", {}, "When ?"],
  ["wait", { duration: { quantity: [10, "MIN"] } }, "wait 10\u202fmin"],
  ["wait", { duration: 90 }, "wait 1\u202fmin 30\u202fs"],
  ["wait", {}, "wait ?"],
  ["wait", { until: { op: "<", args: [{ property: ["oven", "temperature"] }, 40] } }, "Curing Oven temperature < 40"],
  ["move", { to: { device: "oven" } }, "Move to Curing Oven"],
  ["move", {}, "Move to ?"],
  ["pick", { object: "box" }, "? × box"],
  ["pick_and_drop", { quantity: 2, object: "box" }, "2 × box"],
  ["if", {}, "IF"],
  ["while", {}, "While"],
  ["return", { value: { property: ["oven", "temperature"] } }, "Return temperature"],
  ["teleport", {}, "Unknown step"],
  ["call", { function: "mix", args: { shade: "teal" }, result: "total" }, "total = mixPaint (shade: teal)"],
])("a %s with %j reads %s", (kind, params, text) => {
  expect(say(kind, params)).toBe(text);
});

test.each<[Value, string]>([
  [{ at: { role: "robot" } }, "Carrier"],
  [{ op: "in", args: [{ at: { role: "robot" } }, { zone: "z1" }] }, "Carrier in Aisle"],
  [{ op: "*", args: [{ op: "+", args: [1, 2] }, 3] }, "(1 + 2) × 3"],
  [{ op: "-", args: [5, { op: "-", args: [3, 1] }] }, "5 − (3 − 1)"],
  [{ op: "and", args: [true, { op: "or", args: [false, true] }] }, "yes and (no or yes)"],
  [{ op: "not", args: [{ op: "==", args: [{ param: "x" }, 1] }] }, "not x = 1"],
  [
    { op: "distance", args: [{ at: { role: "robot" } }, { at: { device: "oven" } }] },
    "distance from Carrier to Curing Oven",
  ],
  [["a", 2], "a, 2"],
])("the value %j reads %s", (value, text) => {
  expect(valueText(value, speaker)).toBe(text);
});

test("a value that is missing within a sentence has its mark where the value would stand", () => {
  const german = { ...speaker, t: (key: string) => (key === "chip.repeat" ? "⟦times⟧ Mal tun" : t(key)) };
  const untranslated = {
    ...german,
    t: (key: string, values?: Record<string, unknown>) =>
      key.endsWith("_missing") ? String(values?.defaultValue) : german.t(key),
  };
  expect(chipText({ kind: "repeat", params: {} }, untranslated)).toEqual([
    { text: "?", tone: "missing" },
    { text: "Mal tun", tone: "plain" },
  ]);
  expect(chipText({ kind: "repeat", params: { times: 2 } }, untranslated)).toEqual([
    { text: "2 Mal tun", tone: "plain" },
  ]);
});

test("what is one piece of text on the chip stays one, so that no gap opens in it", () => {
  expect(chipText({ kind: "move", params: { to: { device: "oven" } } }, speaker)).toEqual([
    { text: "Move to Curing Oven", tone: "plain" },
  ]);
  expect(chipText({ kind: "repeat", params: { times: 3 } }, speaker)).toEqual([
    { text: "repeat", tone: "word" },
    { text: "3", tone: "plain" },
    { text: "×", tone: "word" },
  ]);
});

test("a colour has a swatch before its name", () => {
  expect(chipText({ kind: "set", params: { variable: "shade", value: "teal" } }, speaker)).toEqual([
    { text: "shade", tone: "plain" },
    { text: "=", tone: "word" },
    { text: "teal", tone: "plain", swatch: "teal" },
  ]);
});

test("a comment says its first words, or that it waits for them", () => {
  expect(say("comment", { text: " Keep 2 cans? " })).toBe("Keep 2 cans?");
  expect(chipText({ kind: "comment", params: {} }, speaker)).toEqual([{ text: "Write a note", tone: "soft" }]);
});
