import { expect, test } from "vitest";
import { insertsFor, messageFrom, messageText } from "./message";
import type { Value } from "@/program/document/document";

const COUNT: Value = { param: "count" };
const SUM: Value = { op: "+", args: [COUNT, 1] };
const label = (value: Value) => (value === SUM ? "count + 1" : "count");
const INSERTS = [{ label: "count", value: COUNT }];

test("values stand in braces, and come back from there", () => {
  const message: Value = { op: "text", args: ["Painted ", COUNT, " boxes"] };
  expect(messageText(message, insertsFor(message, INSERTS, label))).toBe("Painted {count} boxes");
  expect(messageFrom("Painted {count} boxes", INSERTS)).toEqual(message);
});

test("text without values is just text, and nothing is nothing", () => {
  expect(messageFrom("Done", INSERTS)).toBe("Done");
  expect(messageFrom("", INSERTS)).toBeNull();
});

test("braces around what is not known are text", () => {
  expect(messageFrom("Use {curly} ones", INSERTS)).toBe("Use {curly} ones");
});

test("a value alone is a message, too", () => {
  expect(messageFrom("{count}", INSERTS)).toEqual({ op: "text", args: [COUNT] });
});

test("values that were written elsewhere survive an edit of the text around them", () => {
  const message: Value = { op: "text", args: ["Now ", SUM] };
  expect(messageFrom("Then {count + 1}!", insertsFor(message, INSERTS, label))).toEqual({
    op: "text",
    args: ["Then ", SUM, "!"],
  });
});

test("a message that is one value keeps it when words come to it", () => {
  expect(messageText(SUM, insertsFor(SUM, INSERTS, label))).toBe("{count + 1}");
  expect(messageFrom("Box {count + 1}", insertsFor(SUM, INSERTS, label))).toEqual({ op: "text", args: ["Box ", SUM] });
});

const level = (device: string | { role: string }): Value => ({ property: [device, "level"] });
const mixer = () => "Mixer level";

test("readings of devices of one name stay what they are in an edited text", () => {
  const message: Value = { op: "text", args: ["left ", level("m1"), ", right ", level("m2")] };
  const inserts = insertsFor(message, [], mixer);
  const text = messageText(message, inserts);
  expect(text).toBe("left {Mixer level (m1)}, right {Mixer level (m2)}");
  expect(messageFrom(`${text}!`, inserts)).toEqual({ op: "text", args: [...message.args, "!"] });
});

test("what is offered is told from what the message has under the same label", () => {
  const message: Value = { op: "text", args: ["Level ", level("m2")] };
  const offered = ["m1", "m2", { role: "r1" }].map((each) => ({ label: "Mixer level", value: level(each) }));
  const inserts = insertsFor(message, offered, mixer);
  expect(inserts.map((each) => each.label).sort()).toEqual([
    "Mixer level (m1)",
    "Mixer level (m2)",
    "Mixer level (r1)",
  ]);
  const next = messageFrom(`${messageText(message, inserts)}, {Mixer level (m1)}`, inserts);
  expect(next).toEqual({ op: "text", args: ["Level ", level("m2"), ", ", level("m1")] });
});

test("calculations that read alike are counted, and braces in a name are none", () => {
  const twice: readonly Value[] = [1, 2].map((by) => ({ op: "*", args: [COUNT, by] }));
  const message: Value = { op: "text", args: twice };
  const inserts = insertsFor(message, [], () => "Box {a}");
  const text = messageText(message, inserts);
  expect(text).toBe("{Box (a)}{Box (a) (2)}");
  expect(messageFrom(text, inserts)).toEqual(message);
});
