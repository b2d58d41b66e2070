import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { namesOfLoops, namesSetIn, ownNames } from "./scopes";

const at = (kind: string, place: Step["place"], params: Step["params"]): Step => ({ kind, place, params });
const DOCUMENT: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  functions: { mix: { name: "mix", parameters: [{ name: "minutes", type: "number" }] } },
  steps: {
    event: at("on_event", ["program", "events", "A"], { condition: true }),
    seen: at("set", ["event", "body", "A"], { variable: "seen", value: 1 }),
    each: at("for_each", ["program", "body", "A"], { variable: "item", index: "number", items: [1] }),
    inner: at("set", ["each", "body", "A"], { variable: "item", value: 2 }),
    draft: at("set", null, { variable: "later", value: 2 }),
    asked: at("ask", ["mix", "body", "A"], { question: "?", answer: { type: "text" }, variable: "answer" }),
    both: at("call", ["mix", "body", "B"], { function: "mix", args: {}, result: "seen" }),
    item: at("set", ["mix", "body", "C"], { variable: "item", value: 2 }),
  },
};

test("what the program and its events set is the program's, without the names of loops and drafts", () => {
  expect(namesSetIn(DOCUMENT).get("program")).toEqual(new Set(["seen"]));
});

test("parameters and what only a function sets are its own", () => {
  expect(ownNames(DOCUMENT, "mix")).toEqual(new Set(["minutes", "answer", "item"]));
});

test("a loop gives its names to what stands in it, and not to itself", () => {
  expect(namesOfLoops(DOCUMENT, "inner")).toEqual(new Set(["item", "number"]));
  expect(namesOfLoops(DOCUMENT, "each")).toEqual(new Set());
});
