// @vitest-environment jsdom
import "fake-indexeddb/auto";
import { afterEach, beforeEach, expect, test } from "vitest";
import type { Edit } from "../edits/edits";
import { applyEditsToDoc, SharedProgram } from "../shared/sharedProgram";
import type { OpenProgram } from "./context";
import { resetUi, useUi } from "./ui";
import { doAndSay, goBack, takeOffer, undoDownTo } from "./undoing";

const STEP = { kind: "wait", place: ["program", "body", "A"], pos: [1, -1], params: { duration: 1 } } as const;
let shared: SharedProgram;
let open: Pick<OpenProgram, "shared" | "t">;

const lasts = (id: string, value: number): Edit => ({ do: "set_param", id, name: "duration", value });
const mine = (...edits: Edit[]) => shared.apply(edits);
const others = (...edits: Edit[]) => applyEditsToDoc(shared.doc, edits, "somebody else");
const durationOf = (id: string) => shared.getDocument().steps[id]?.params.duration;
const said = () => useUi.getState().toast?.text ?? null;
const doIt = (text: string, ...edits: Edit[]) =>
  doAndSay(
    open,
    () => mine(...edits),
    () => text,
  );
const pressInToast = () => {
  const offer = useUi.getState().toast?.offer;
  if (offer) takeOffer(open, offer);
};

beforeEach(() => {
  shared = new SharedProgram("p", "ws://nowhere.invalid", "1");
  shared.provider.emit("sync", [true]);
  open = { shared, t: (key: string) => key };
  others(...["a", "b"].map((id): Edit => ({ do: "add_step", id, step: STEP })));
  resetUi();
});
afterEach(() => shared.close());

test("what nobody has touched since is undone and redone without a question", () => {
  mine(lasts("a", 2));
  goBack(open, "undo");
  expect([durationOf("a"), said()]).toEqual([1, null]);
  goBack(open, "redo");
  expect([durationOf("a"), said()]).toEqual([2, null]);
});

test("Undo asks before it overwrites what somebody has set since, and does it then", () => {
  mine(lasts("a", 2));
  others(lasts("a", 5));
  goBack(open, "undo");
  expect([durationOf("a"), said()]).toEqual([5, "gesture.overwritten"]);
  pressInToast();
  expect([durationOf("a"), said()]).toEqual([1, null]);
});

test("Redo asks before it overwrites what somebody has set since, and does it then", () => {
  mine(lasts("a", 2));
  goBack(open, "undo");
  others(lasts("a", 5));
  goBack(open, "redo");
  expect([durationOf("a"), said()]).toEqual([5, "gesture.overwritten_redo"]);
  pressInToast();
  expect([durationOf("a"), said()]).toEqual([2, null]);
});

test("Undo asks after a Redo, too", () => {
  mine(lasts("a", 2));
  for (let round = 0; round < 3; round += 1) {
    goBack(open, "undo");
    goBack(open, "redo");
  }
  others(lasts("a", 5));
  goBack(open, "undo");
  expect([durationOf("a"), said()]).toEqual([5, "gesture.overwritten"]);
});

test("where nothing is left of the last entry, Undo asks about the one before it", () => {
  mine(lasts("a", 2));
  mine(lasts("b", 9));
  others(lasts("a", 5), { do: "remove_step", id: "b" });
  goBack(open, "undo");
  expect([durationOf("a"), said(), shared.undo.length]).toEqual([5, "gesture.overwritten", 1]);
});

test("a removed step that somebody has put back and worked on is not replaced without a question", () => {
  mine({ do: "remove_step", id: "a" });
  others({ do: "add_step", id: "a", step: { ...STEP, params: { duration: 8 } } });
  goBack(open, "undo");
  expect([durationOf("a"), said()]).toEqual([8, "gesture.overwritten"]);
  pressInToast();
  expect(durationOf("a")).toBe(1);
});

const addOwn = () => mine({ do: "add_step", id: "c", step: STEP });

test("Undo asks before it takes away a step that somebody has worked on since, and gives all back if done again", () => {
  addOwn();
  goBack(open, "undo");
  goBack(open, "redo");
  expect([durationOf("c"), said()]).toEqual([1, null]);
  others(lasts("c", 5));
  goBack(open, "undo");
  expect([durationOf("c"), said()]).toEqual([5, "gesture.worked_on"]);
  pressInToast();
  expect([durationOf("c"), said()]).toEqual([undefined, null]);
  goBack(open, "redo");
  expect(durationOf("c")).toBe(5);
});

test("Undo asks before it takes away a step into which somebody has drawn", () => {
  addOwn();
  others({ do: "add_step", id: "d", step: { ...STEP, place: ["c", "body", "A"] } });
  goBack(open, "undo");
  expect([durationOf("c"), said()]).toEqual([1, "gesture.worked_on"]);
});

const wrap = () =>
  mine(
    { do: "set_function", id: "f", value: { name: "mix", parameters: [] } },
    { do: "set_place", id: "a", place: ["f", "body", "A"] },
    { do: "add_step", id: "call", step: { ...STEP, kind: "call", params: { function: "f" } } },
  );
const functions = () => Object.values(shared.getDocument().functions).map(({ name }) => name);

test("Undo asks before it takes away a function into which somebody has drawn, or which they call", () => {
  for (const theirs of [
    { ...STEP, place: ["f", "body", "B"] },
    { ...STEP, kind: "call", params: { function: "f" } },
  ] as const) {
    wrap();
    goBack(open, "undo");
    goBack(open, "redo");
    expect([functions(), said()]).toEqual([["mix"], null]);
    others({ do: "add_step", id: "theirs", step: theirs });
    goBack(open, "undo");
    expect([functions(), said()]).toEqual([["mix"], "gesture.worked_on"]);
    pressInToast();
    expect([functions(), said()]).toEqual([[], null]);
    others({ do: "remove_step", id: "theirs" });
  }
});

test("a function that was only renamed is not taken away, whoever draws into it or calls it", () => {
  wrap();
  mine({ do: "set_function", id: "f", value: { name: "stir", parameters: [] } });
  others({ do: "add_step", id: "theirs", step: { ...STEP, place: ["f", "body", "B"] } });
  for (const [way, name] of [
    ["undo", "mix"],
    ["redo", "stir"],
    ["undo", "mix"],
  ] as const) {
    goBack(open, way);
    expect([functions(), said()]).toEqual([[name], null]);
  }
});

test("Redo asks before it takes away a step that somebody has worked on since", () => {
  mine({ do: "remove_step", id: "a" });
  goBack(open, "undo");
  others(lasts("a", 5));
  goBack(open, "redo");
  expect([durationOf("a"), said()]).toEqual([5, "gesture.worked_on"]);
});

test("what I did to my own step, and what the program put right, is no work of others", () => {
  addOwn();
  shared.adjust([{ do: "set_pos", id: "c", pos: [3, 3] }]);
  mine(lasts("c", 4));
  mine({ do: "set_pos", id: "c", pos: [5, 5] });
  shared.adjust([{ do: "set_pos", id: "c", pos: [6, 6] }]);
  for (const left of [4, 1, undefined]) {
    goBack(open, "undo");
    if (left === 4) expect(shared.getDocument().steps.c?.pos).toEqual([3, 3]);
    expect([durationOf("c"), said()]).toEqual([left, null]);
  }
});

test("a field that is left by Esc asks before it overwrites what somebody has set since", () => {
  const { length } = shared.undo;
  shared.visits.begin();
  mine(lasts("a", 2));
  undoDownTo(open, length);
  expect(durationOf("a")).toBe(1);
  mine(lasts("a", 3));
  others(lasts("a", 5));
  undoDownTo(open, length);
  expect([durationOf("a"), said()]).toEqual([5, "gesture.overwritten"]);
});

test("what a toast offers is done to what it names, asked about like any Undo, and only while that comes next", () => {
  doIt("removed", { do: "remove_step", id: "b" });
  mine(lasts("a", 2));
  pressInToast();
  expect([durationOf("a"), durationOf("b")]).toEqual([2, undefined]);
  doIt("set", lasts("a", 3));
  others(lasts("a", 5));
  pressInToast();
  expect([durationOf("a"), said()]).toEqual([5, "gesture.overwritten"]);
});

test("nothing is said of what did nothing, so that no toast takes back an older gesture", () => {
  mine(lasts("a", 2));
  doIt("removed");
  expect([said(), useUi.getState().toast]).toEqual([null, null]);
  doIt("removed", { do: "remove_step", id: "gone" });
  expect(said()).toBeNull();
  doIt("removed", { do: "remove_step", id: "b" });
  expect(said()).toBe("removed");
  pressInToast();
  expect([durationOf("a"), durationOf("b")]).toEqual([2, 1]);
});
