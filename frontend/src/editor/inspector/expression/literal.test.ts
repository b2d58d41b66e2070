import { expect, test } from "vitest";
import { choicesOf, readPlain, writePlain, type Wanted } from "./literal";

const wanted = (more: Partial<Wanted>): Wanted => ({
  type: undefined,
  options: [],
  names: new Set(["count", "shade"]),
  yes: "ja",
  no: "nein",
  comma: true,
  ...more,
});

test("numbers need no reading, with a comma where people write one", () => {
  expect(readPlain(" 2.5 ", wanted({ type: "number" }))).toEqual({ value: 2.5 });
  expect(readPlain("2,5", wanted({ type: "number" }))).toEqual({ value: 2.5 });
  expect(readPlain("1,000", wanted({ type: "number", comma: false }))).toBeNull();
  expect(readPlain("10 min", wanted({ type: "number" }))).toBeNull();
});

test("an empty line is a missing value", () => {
  expect(readPlain("  ", wanted({ type: "text" }))).toEqual({ value: null });
  expect(writePlain(null, wanted({}))).toBe("");
});

test("where a text is wanted it needs no quotation marks, unless it is a name", () => {
  expect(readPlain("box", wanted({ type: "object" }))).toEqual({ value: "box" });
  expect(readPlain("shade", wanted({ type: "text" }))).toBeNull();
  expect(readPlain("box", wanted({ type: "number" }))).toBeNull();
  expect(readPlain("box", wanted({}))).toBeNull();
  expect(writePlain("box", wanted({ type: "object" }))).toBe("box");
  expect(writePlain("shade", wanted({ type: "text" }))).toBe('"shade"');
  expect(writePlain("box", wanted({}))).toBe('"box"');
  expect(writePlain('a "b"', wanted({ type: "text" }))).toBeNull();
});

test("yes and no are written in the language of the screen", () => {
  expect(readPlain("Ja", wanted({ type: "boolean" }))).toEqual({ value: true });
  expect(readPlain("False", wanted({ type: "boolean" }))).toEqual({ value: false });
  expect(readPlain("vielleicht", wanted({ type: "boolean" }))).toBeNull();
  expect(writePlain(false, wanted({ type: "boolean" }))).toBe("nein");
  expect(writePlain(true, wanted({}))).toBe("True");
  expect(choicesOf(wanted({ type: "boolean" }))).toEqual(["ja", "nein"]);
});

test("options are read as what they are, and one that is also a name is written with quotation marks", () => {
  expect(readPlain("7", wanted({ type: "text", options: ["7"] }))).toEqual({ value: "7" });
  expect(readPlain("3", wanted({ type: "integer", options: [1, 3] }))).toEqual({ value: 3 });
  expect(choicesOf(wanted({ type: "text", options: ["teal", "shade"] }))).toEqual(["teal", '"shade"']);
});
