import { beforeEach, expect, test } from "vitest";
import { clip } from "../edits/clipping";
import { applyEdits, type Edit } from "../edits/edits";
import { branchOf } from "../edits/joints";
import { wrapInFunction } from "../edits/calls";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { lastChosen, standingAlone } from "@/program/document/called";
import { readTree } from "@/program/document/tree";
import { branchNow, createStep, duplicateSelected, pasteClipping, removeSelected } from "./actions";
import type { OpenProgram } from "./context";
import { answerWaiting } from "./putting";
import { resetUi, select, useUi } from "./ui";

beforeEach(resetUi);

const step = (kind: string, place: Step["place"], params: Step["params"] = {}): Step => ({
  kind,
  place,
  pos: [1, -1],
  params,
});

/** The program calls mix, which calls stir; the other two of these call each other, and nobody calls them. */
const program: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  functions: Object.fromEntries(["mix", "stir", "ping", "pong"].map((id) => [id, { name: id, parameters: [] }])),
  steps: {
    first: step("wait", ["program", "body", "A"]),
    call: step("call", ["program", "body", "B"], { function: "mix" }),
    inner: step("call", ["mix", "body", "A"], { function: "stir" }),
    deep: step("wait", ["stir", "body", "A"]),
    there: step("call", ["ping", "body", "A"], { function: "pong" }),
    back: step("call", ["pong", "body", "A"], { function: "ping" }),
  },
};
const all = readTree(program).reading;
const called = all.filter((id) => id !== "there" && id !== "back");

/** What the program's own branches hold after the edits of an act, with all steps selected. */
function after(act: (document: ProgramDocument, apply: (edits: readonly Edit[]) => void) => void, from = program) {
  useUi.setState({ selected: called });
  let document = from;
  act(document, (edits) => (document = applyEdits(document, edits)));
  return document;
}
const branch = (document: ProgramDocument, parent: string) =>
  readTree(document)
    .children(parent, "body")
    .map((id) => document.steps[id]?.kind);

test("of all steps those of functions that the others call come along with their function alone", () => {
  const { outer, bodies } = clip(program, called);
  expect(outer).toEqual(["first", "call"]);
  expect(Object.keys(bodies).sort()).toEqual(["deep", "inner"]);
  expect(clip(program, ["inner", "deep"]).outer).toEqual(["inner"]);
  expect(clip(program, all).outer).toEqual(["first", "call", "back"]);
});

test("copies of all steps stand behind them in the program, and a function keeps its own", () => {
  for (const copied of [
    after(duplicateSelected),
    after((document, apply) => {
      const shared = { getDocument: () => document };
      const open = { document, shared, apply, devices: [], plan: null, program: { id: "a" } } as unknown as OpenProgram;
      pasteClipping(open, clip(document, called), {});
    }),
  ]) {
    expect(branch(copied, "program")).toEqual(["wait", "call", "wait", "call"]);
    expect(branch(copied, "mix")).toEqual(["call"]);
    expect(branch(copied, "stir")).toEqual(["wait"]);
  }
});

test("of all steps the last of the program's own is the one behind which others go, never one of a function or event", () => {
  const event = step("on_event", ["program", "events", "A"]);
  const eventful = { ...program, steps: { ...program.steps, event, late: step("wait", ["event", "body", "A"]) } };
  const { reading } = readTree(eventful);
  expect(lastChosen(eventful, reading)).toBe("call");
  expect([[], ["there", "back"], ["deep", "inner"], ["late"]].map((ids) => lastChosen(eventful, ids))).toEqual([
    ...[null, "back", "inner", "late"],
  ]);
  useUi.setState({ selected: reading });
  expect(branchNow(eventful)).toEqual({ parent: "program", branch: "body" });
  duplicateSelected(eventful, (edits) => expect(branch(applyEdits(eventful, edits), "pong")).toEqual(["call"]));
});

test("however many functions are selected with what calls them, the tree is read once", () => {
  const names = Array.from({ length: 30 }, (_, at) => `f${at}`);
  let count = 0;
  const functions = new Proxy(Object.fromEntries(names.map((name) => [name, { name, parameters: [] }])), {
    ownKeys: (all) => ((count += 1), Object.keys(all)),
  });
  const steps = Object.fromEntries([
    ...names.map((id, at) => [`in ${id}`, step("wait", [id, "body", "A"], { at })] as const),
    ...names.map((id) => [`call ${id}`, step("call", ["program", "body", id], { function: id })] as const),
  ]);
  const many = { ...EMPTY_DOCUMENT, functions, steps };
  readTree({ ...many });
  const once = count;
  expect(standingAlone(many, Object.keys(steps))).toHaveLength(30);
  expect(count).toBe(2 * once);
});

test("what is cut leaves the functions that it calls as they were", () => {
  const rest = after((document, apply) => removeSelected(document, apply, clip(document, called).outer));
  expect(branch(rest, "program")).toEqual([]);
  expect(branch(rest, "mix")).toEqual(["call"]);
});

test("a function is made of all steps of the program, which call others", () => {
  const decision = wrapInFunction(program, called, { functionId: "day", callId: "fresh", name: "day" });
  const made = applyEdits(program, "edits" in decision ? decision.edits : []);
  expect(branch(made, "program")).toEqual(["call"]);
  expect(branch(made, "day")).toEqual(["wait", "call"]);
  expect(branch(made, "mix")).toEqual(["call"]);
});

test("a new step goes to the chosen spot, to the end of its branch where its neighbour has gone, else where it went before", () => {
  const drawn = (branch: { parent: string; branch: string }, after?: string | null) => {
    resetUi();
    useUi.setState({ into: { branch, link: "", word: "", after } });
    let document = program;
    createStep(document, (edits) => (document = applyEdits(document, edits)), {
      kind: "drop",
      pos: [0, 0],
      params: {},
    });
    return [branchOf(document, useUi.getState().selected[0] ?? "")?.parent, branchAll(document)];
  };
  const branchAll = (document: ProgramDocument) => branch(document, "program").join(" ");
  const own = { parent: "program", branch: "body" };
  expect(drawn(own, "first")).toEqual(["program", "wait drop call"]);
  expect(drawn(own, null)).toEqual(["program", "drop wait call"]);
  expect(drawn(own, "lost")).toEqual(["program", "wait call drop"]);
  expect(drawn({ parent: "mix", branch: "body" })[0]).toBe("mix");
  expect(drawn({ parent: "lost", branch: "body" }, "first")).toEqual(["program", "wait call drop"]);
  expect(drawn({ parent: "lost", branch: "body" })).toEqual(["program", "wait call drop"]);
});

test("what waits for somebody to stand in goes into the program as it is then", () => {
  const steps = { pick: step("operate", ["program", "body", "A"], { device: { device: "oven" } }) };
  const clipping = clip({ ...EMPTY_DOCUMENT, steps }, ["pick"]);
  let document = program;
  const open = {
    document,
    shared: { getDocument: () => document },
    apply: (edits: readonly Edit[]) => (document = applyEdits(document, edits)),
    devices: [],
    plan: null,
    program: { id: "a" },
  } as unknown as OpenProgram;
  select(["first"]);
  pasteClipping(open, clipping, {});
  expect(useUi.getState().dialog).toBe("strangers");
  document = applyEdits(document, [{ do: "remove_step", id: "first" }]);
  answerWaiting(new Map());
  expect(branch(document, "program")).toEqual(["call", "operate"]);
});
