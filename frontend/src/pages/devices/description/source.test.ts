import { expect, test } from "vitest";
import { tokenise, type Dialect } from "./source";

const kinds = (line: string, dialect: Dialect) =>
  tokenise(line, dialect)
    .filter((token) => token.kind)
    .map((token) => `${token.kind} ${token.text}`);

test("no letter of a line is lost or doubled", () => {
  const line = '  vipo:value "a \\" b"^^xsd:string , 7.50 ; # note';
  const dialects: Dialect[] = ["turtle", "json", "script"];
  for (const dialect of dialects)
    expect(
      tokenise(line, dialect)
        .map((token) => token.text)
        .join(""),
    ).toBe(line);
});

test("turtle: prefixes, addresses, names, strings and numbers", () => {
  expect(kinds("@prefix vipo: <urn:vipo:ns#> .", "turtle")).toEqual(["kw @prefix", "fn vipo:", "cls <urn:vipo:ns#>"]);
  expect(kinds('site:mixer a vipo:Machine ; vipo:x -5.85 ; vipo:name "B"@en .', "turtle")).toEqual([
    "fn site:mixer",
    "kw a",
    "fn vipo:Machine",
    "fn vipo:x",
    "num -5.85",
    "fn vipo:name",
    'str "B"@en',
  ]);
});

test("turtle: the hash within an address begins no comment", () => {
  expect(kinds("<urn:vipo:ns#a> # and so on", "turtle")).toEqual(["cls <urn:vipo:ns#a>", "com # and so on"]);
});

test("json: a key is not a string", () => {
  expect(kinds('"name": "x", "n": [1e3, null]', "json")).toEqual([
    'fn "name"',
    'str "x"',
    'fn "n"',
    "num 1e3",
    "kw null",
  ]);
});

test("script: words of the language, calls and self", () => {
  expect(kinds('if self.oven.temperature < 60: wait(5)  # "hot"', "script")).toEqual([
    "kw if",
    "self self",
    "num 60",
    "fn wait",
    "num 5",
    'com # "hot"',
  ]);
});

test("an empty line has no tokens", () => {
  expect(tokenise("", "turtle")).toEqual([]);
});

test("the paper's message is coloured by keys, texts and truths", () => {
  const tokens = (line: string) => tokenise(line, "message").map(({ kind, text }) => [kind, text]);
  expect(tokens('  topic_name: "a: b"')).toEqual([
    ["fn", "  topic_name"],
    ["", ": "],
    ["str", '"a: b"'],
  ]);
  expect(tokens("done: False")).toEqual([
    ["fn", "done"],
    ["", ": "],
    ["kw", "False"],
  ]);
});
