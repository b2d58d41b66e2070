import { expect, test } from "vitest";
import { branchesOf, readTree } from "./tree";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "./document";

function step(kind: string, place: Step["place"] = null): Step {
  return { kind, place, pos: null, params: {} };
}

function documentOf(steps: Record<string, Step>): ProgramDocument {
  return { ...EMPTY_DOCUMENT, steps };
}

test("events are read behind the program with what stands in them", () => {
  const tree = readTree(
    documentOf({
      move: step("move", ["program", "body", "V"]),
      hot: step("on_event", ["program", "events", "V"]),
      tell: step("notify", ["hot", "body", "V"]),
    }),
  );
  expect(tree.reading).toEqual(["move", "hot", "tell"]);
  expect([tree.depth("hot"), tree.depth("tell")]).toEqual([0, 1]);
});

test("only an event stands among the events, and an event stands nowhere else", () => {
  const tree = readTree(
    documentOf({
      move: step("move", ["program", "events", "V"]),
      hot: step("on_event", ["program", "body", "V"]),
    }),
  );
  expect(tree.reading).toEqual([]);
  expect(tree.drafts).toEqual(["hot", "move"]);
});

test("a comment is neither a step of the program nor a draft", () => {
  const tree = readTree(documentOf({ note: step("comment"), stray: step("comment", ["program", "body", "V"]) }));
  expect([tree.reading, tree.drafts]).toEqual([[], []]);
});

test("a try has a body, a catch and a finally; every loop has a body", () => {
  expect(branchesOf(step("try"))).toEqual(["body", "catch", "finally"]);
  expect(["while", "repeat", "for_each", "on_event"].map((kind) => branchesOf(step(kind)))).toEqual(
    Array(4).fill(["body"]),
  );
});

test("a document is read once, and what has become of it anew", () => {
  const document = documentOf({ move: step("move", ["program", "body", "V"]) });
  expect(readTree(document)).toBe(readTree(document));
  const more = { ...document, steps: { ...document.steps, wait: step("wait", ["program", "body", "W"]) } };
  expect(readTree(more).reading).toEqual(["move", "wait"]);
  expect(readTree(document).reading).toEqual(["move"]);
});
