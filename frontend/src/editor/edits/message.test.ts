import { expect, test } from "vitest";
import { insertsOf, messageFrom, messageText } from "./message";
import type { Value } from "@/program/document/document";

const COUNT: Value = { param: "count" };
const SUM: Value = { op: "+", args: [COUNT, 1] };
const label = (value: Value) => (value === SUM ? "count + 1" : "count");
const INSERTS = [{ label: "count", value: COUNT }];

test("values stand in braces, and come back from there", () => {
  const message: Value = { op: "text", args: ["Painted ", COUNT, " boxes"] };
  expect(messageText(message, label)).toBe("Painted {count} boxes");
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
  expect(messageFrom("Then {count + 1}!", insertsOf(message, label))).toEqual({
    op: "text",
    args: ["Then ", SUM, "!"],
  });
});
