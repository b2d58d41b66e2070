/** The languages say the same things, and every text that the screens ask for is there. */
import { expect, test } from "vitest";
import { gatherAreas } from "./areas";
import * as enBase from "./catalogue.en";
import * as enScreens from "./catalogue.screens.en";
import * as deBase from "./catalogue.de";
import * as deScreens from "./catalogue.screens.de";

const [englishBase, englishScreens] = [gatherAreas(enBase.texts), gatherAreas(enScreens.texts)];
const [germanBase, germanScreens] = [gatherAreas(deBase.texts), gatherAreas(deScreens.texts)];

type Texts = Record<string, string>;
const sources = import.meta.glob<string>(["../**/*.{ts,tsx}", "!../**/*.test.ts"], {
  eager: true,
  query: "?raw",
  import: "default",
});

/** `{"shell.stop.all": "Stop all", …}`. */
function flatten(texts: Record<string, unknown>, before = ""): Texts {
  const flat: Texts = {};
  for (const [key, value] of Object.entries(texts)) {
    if (typeof value === "string") flat[before + key] = value;
    else Object.assign(flat, flatten(value as Record<string, unknown>, `${before}${key}.`));
  }
  return flat;
}

const [en, de] = [
  { ...flatten(englishBase), ...flatten(englishScreens) },
  { ...flatten(germanBase), ...flatten(germanScreens) },
];
const areasOf = (...parts: object[]) => [...new Set(parts.flatMap((part) => Object.keys(part)))].sort();
const areas = areasOf(englishBase, englishScreens);
const holes = (text: string) =>
  [...new Set(text.match(/\{\{\s*\w+/g) ?? [])].map((each) => each.replace(/\W/g, "")).sort();
const PLURAL = /_(zero|one|two|few|many|other)$/;

test("both languages have the same areas", () => {
  expect(areasOf(germanBase, germanScreens)).toEqual(areas);
  expect(areas).toEqual(expect.arrayContaining(["editor", "pages", "run", "shell"]));
});

test("no text is in both parts", () => {
  const late = Object.keys(flatten(englishScreens));
  expect(Object.keys(flatten(englishBase)).filter((key) => late.includes(key))).toEqual([]);
});

test("both languages have the same texts, plural forms too", () => {
  expect(Object.keys(de).sort()).toEqual(Object.keys(en).sort());
});

test("each text has the same places for values in both languages", () => {
  const different = Object.keys(en).filter((key) => holes(en[key] ?? "").join() !== holes(de[key] ?? "").join());
  expect(different).toEqual([]);
});

test("every text that stands within another exists", () => {
  const within = (texts: Texts) => Object.values(texts).flatMap((text) => [...text.matchAll(/\$t\(([^)]*)\)/g)]);
  for (const texts of [en, de]) {
    const named = within(texts).map(([, key = ""]) => key);
    expect(named.filter((key) => !(key in texts))).toEqual([]);
    expect(named).toContain("pages.devices.anyForm");
  }
});

test("no text is empty", () => {
  const empty = (texts: Texts) => Object.keys(texts).filter((key) => !texts[key]?.trim());
  expect([empty(en), empty(de)]).toEqual([[], []]);
});

test("where there is one plural form, the languages' other forms are there", () => {
  const stems = [...new Set(Object.keys(en).filter((key) => PLURAL.test(key)))].map((key) => key.replace(PLURAL, ""));
  const missing = [...new Set(stems)].filter((stem) => !(`${stem}_one` in en && `${stem}_other` in en));
  expect(missing).toEqual([]);
});

test("a text with places for values is asked for with values", () => {
  const bare = Object.entries(sources).flatMap(([file, text]) =>
    [...text.matchAll(/\bt\(\s*["']([\w.-]+)["']\s*,?\s*\)/g)].map(([, key = ""]) => ({ file, key })),
  );
  // A key that begins within an area may be that of another one, too.
  const textsOf = (key: string) =>
    ["", ...areas.map((area) => `${area}.`)].flatMap((area) => en[area + key] ?? en[`${area}${key}_other`] ?? []);
  const needsValues = (key: string) => textsOf(key).length > 0 && textsOf(key).every((text) => holes(text).length > 0);
  expect(bare.filter(({ key }) => needsValues(key))).toEqual([]);
  expect(bare.length).toBeGreaterThan(200);
});

/** Literal keys given to a `t` of the whole catalogue; the editor's own `t` begins within its area. */
function askedFor(): { file: string; key: string }[] {
  return Object.entries(sources).flatMap(([file, text]) =>
    [...text.replace(/\/\*[\s\S]*?\*\//g, "").matchAll(/\bt\(\s*["']([\w.-]+)["']/g)].map((match) => ({
      file,
      key: match[1] ?? "",
    })),
  );
}

test("every text that the source asks for by name exists", () => {
  const known = (key: string) => key in en || `${key}_other` in en;
  const missing = askedFor().filter(({ key }) => !known(key) && !areas.some((area) => known(`${area}.${key}`)));
  expect(missing).toEqual([]);
  expect(askedFor().length).toBeGreaterThan(200);
});
