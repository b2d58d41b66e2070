import { expect, test } from "vitest";
import { suggest, suggestChoices, take, type LineName } from "./suggestions";

const NAMES: readonly LineName[] = [
  { name: "count", kind: "variable", id: "count", properties: [] },
  {
    name: "curing_oven",
    kind: "device",
    id: "oven",
    properties: [
      { name: "temperature", written: "temperature" },
      { name: "Job-Status", written: "job_status" },
    ],
  },
  { name: "dock_1", kind: "place", id: "dock1", properties: [] },
];
const labels = (text: string, caret = text.length) => suggest(text, caret, NAMES).map((each) => each.label);

test("names and functions are offered by what they begin with, then by what they hold", () => {
  expect(labels("cu")).toEqual(["curing_oven"]);
  expect(labels("co")).toEqual(["count", "count"]);
  expect(labels("ck")).toEqual(["dock_1"]);
  expect(labels("o")[0]).not.toBe("o");
});

test("nothing written yet offers everything", () => {
  expect(labels("")).toHaveLength(NAMES.length + 13);
  expect(labels("count > ")).toHaveLength(NAMES.length + 13);
});

test("behind a device and a dot stand its readings", () => {
  expect(labels("1 + curing_oven.")).toEqual(["temperature", "job_status"]);
  expect(labels("curing_oven.job")).toEqual(["job_status"]);
  expect(labels("nobody.")).toEqual([]);
  expect(labels("3.")).toEqual([]);
});

test("a word that is complete needs nothing", () => {
  expect(labels("curing_oven")).toEqual([]);
  expect(labels("curing_oven.temperature")).toEqual([]);
});

test("in a text nothing is offered but in the braces of an f-string", () => {
  expect(labels('"cu')).toEqual([]);
  expect(labels('"it" == cu')).toEqual(["curing_oven"]);
  expect(labels('f"oven {cu')).toEqual(["curing_oven"]);
  expect(labels('f"oven {count} cu')).toEqual([]);
});

test("what is taken replaces the word before the caret only", () => {
  const [chosen] = suggest("cu > 60", 2, NAMES);
  expect(chosen && take("cu > 60", 2, chosen)).toEqual({ text: "curing_oven > 60", caret: 11 });
  const [call] = suggest("dista", 5, NAMES);
  expect(call && take("dista", 5, call)).toEqual({ text: "distance(", caret: 9 });
});

test("what can be chosen is offered by its beginning, all of it in an opened list, and replaces the whole line", () => {
  const choices = ["teal", "tan", "red"];
  const offered = (text: string, all = false) => suggestChoices(text, choices, all).map((each) => each.label);
  expect(offered("t")).toEqual(["teal", "tan"]);
  expect(offered("teal")).toEqual([]);
  expect(offered("teal", true)).toEqual(choices);
  const [chosen] = suggestChoices("re", choices, false);
  expect(chosen && take("re + 1", 2, chosen)).toEqual({ text: "red", caret: 3 });
});

test("names of every language are found by what is written of them", () => {
  const oven = { name: "ofen_süd", kind: "device", id: "o", properties: [{ name: "Füllstand", written: "füllstand" }] };
  const found = (text: string) => suggest(text, text.length, [oven]);
  expect(found("1 + ofen_sü").map(({ insert, from }) => [insert, from])).toEqual([["ofen_süd", 4]]);
  expect(found("ofen_süd.fü").map(({ insert, from }) => [insert, from])).toEqual([["füllstand", 9]]);
});
