import { expect, test } from "vitest";
import { applyEdits } from "./edits";
import { fixEdits } from "./fixes";
import { alreadyImported, importFunction, type CutOut } from "./library";
import { readTree } from "./tree";
import { EMPTY_DOCUMENT } from "./types";

const cut: CutOut = {
  id: "f",
  function: { name: "mixPaint", parameters: [] },
  functions: { g: { name: "rinse", parameters: [] } },
  steps: {
    loop: { kind: "while", place: ["f", "body", "A"], params: {} },
    inside: { kind: "call", place: ["loop", "body", "A"], params: { function: "g", args: {} } },
    rinse: { kind: "wait", place: ["g", "body", "A"], params: { seconds: 1 } },
  },
};

test("an imported function has new ids throughout and knows where it is from", () => {
  let count = 0;
  const { edits, functionId } = importFunction(cut, { library: "lib", version: 3 }, () => `n${(count += 1)}`);
  const document = applyEdits(EMPTY_DOCUMENT, edits);
  const tree = readTree(document);
  const [loop] = tree.children(functionId, "body");
  const [call] = tree.children(loop ?? "", "body");
  const called = String(document.steps[call ?? ""]?.params.function);
  expect(document.functions[functionId]?.source).toEqual({ library: "lib", version: 3 });
  expect(document.functions[called]?.name).toBe("rinse");
  expect(tree.children(called, "body")).toHaveLength(1);
  expect(tree.drafts).toEqual([]);
  expect(alreadyImported(document, "lib", 3)).toBe(functionId);
  expect(alreadyImported(document, "lib", 4)).toBeNull();
});

test("a remedy sets the value inside the arguments and leaves the others", () => {
  const step = { kind: "operate", place: null, params: { args: { time: null, shade: "teal" } } };
  const document = { ...EMPTY_DOCUMENT, steps: { s: step } };
  const edits = fixEdits(document, { label: "", step: "s", field: "args.time", value: 6 });
  expect(applyEdits(document, edits).steps.s?.params).toEqual({ args: { time: 6, shade: "teal" } });
});

test("a draft is joined to the end of the program", () => {
  const document = { ...EMPTY_DOCUMENT, steps: { s: { kind: "wait", place: null, params: {} } } };
  const edits = fixEdits(document, { label: "", step: "s", field: "place", value: null });
  expect(readTree(applyEdits(document, edits)).reading).toEqual(["s"]);
});
