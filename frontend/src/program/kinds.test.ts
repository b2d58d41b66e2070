import { expect, test } from "vitest";
import schema from "@/api/schema.ts?raw";
import { hasVipoIcon } from "@/design/VipoIcon";
import de from "@/i18n/de/editor.json";
import en from "@/i18n/en/editor.json";
import { isStepKind, kindOf, kindWordKey, STEP_KINDS } from "./kinds";

const sources = import.meta.glob<string>(["../**/*.{ts,tsx}", "!../**/*.test.{ts,tsx}", "!../api/schema.ts"], {
  eager: true,
  query: "?raw",
  import: "default",
});
const catalogues = import.meta.glob<string>("../i18n/**/*.json", { eager: true, query: "?raw", import: "default" });

const declared = /^ +StepKind: (.+);$/m.exec(schema)?.[1] ?? "";
const KINDS = [...declared.matchAll(/"(\w+)"/g)].map(([, kind]) => kind ?? "");

/** How many kinds a text names by `form`, of which `KIND` stands for the kind. */
const named = (text: string, form: string) =>
  KINDS.filter((kind) => new RegExp(form.replace("KIND", kind), "m").test(text)).length;

test("every kind of the server's has an icon of its own and its words in every language", () => {
  expect(KINDS.length).toBeGreaterThan(20);
  expect(STEP_KINDS.map(({ kind }) => kind).sort()).toEqual([...KINDS].sort());
  expect(KINDS.filter((kind) => !hasVipoIcon(kindOf(kind).icon))).toEqual([]);
  expect(new Set(KINDS.map((kind) => kindOf(kind).icon)).size).toBe(KINDS.length);
  for (const { kind: words, about, chip } of [en, de]) {
    expect(KINDS.filter((kind) => !words[kind as keyof typeof words])).toEqual([]);
    expect(KINDS.filter((kind) => !about[kind as keyof typeof about])).toEqual([]);
    expect(KINDS.filter((kind) => kind !== "operate" && kind !== "call" && !(kind in chip))).toEqual([]);
  }
});

test("a kind that these screens do not know has a word, too, and no kind is called as JavaScript's own fields are", () => {
  expect([kindWordKey("wait"), kindWordKey("teleport")]).toEqual(["editor.kind.wait", "editor.kind.unknown"]);
  expect([isStepKind("wait"), isStepKind("teleport"), isStepKind("toString")]).toEqual([true, false, false]);
  expect(kindOf("toString").kind).toBe("unknown");
});

test("there is no other list of kinds, of their icons or of their words", () => {
  // The script's completion and the templates have words of its language, some of which are those of kinds.
  const own = /\/(kinds|script\/completion|beginning\/templates)\.ts$/;
  const texts = Object.entries(sources).filter(([path]) => !own.test(path));
  const lists = texts.filter(([, text]) => named(text, `"KIND",?\\s*(\\|(?!\\|)|,|\\])`) > 10);
  expect(lists.map(([path]) => path)).toEqual([]);
  const tables = texts.filter(([, text]) => named(text, "^ +KIND: ") > 5);
  expect(tables.filter(([, text]) => !text.includes("Record<StepKind,")).map(([path]) => path)).toEqual([]);
  const words = Object.entries(catalogues).filter(([, text]) => named(text, `^    "KIND": "`) > 5);
  expect(words.map(([path]) => path).sort()).toEqual(["../i18n/de/editor.json", "../i18n/en/editor.json"]);
});
