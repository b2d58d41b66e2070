import { beforeEach, expect, test } from "vitest";
import { toMetres } from "@/map/plane/projection";
import { EMPTY_DOCUMENT, type ProgramDocument } from "@/program/document/document";
import { STEP_KINDS } from "@/program/kinds";
import type { OpenProgram } from "./context";
import { freshParams, goIntoAt } from "./newStep";
import { asksForDevice, RESTING } from "./tool";
import { resetUi, useUi } from "./ui";

beforeEach(resetUi);

const DOCUMENT: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  steps: { s: { kind: "ask", params: { variable: "answer" } } },
};

test("a fresh step knows what its record lets it know", () => {
  expect(freshParams("parallel", DOCUMENT)).toEqual({ branches: ["a", "b"] });
  expect(freshParams("try", DOCUMENT)).toEqual({ kinds: [] });
  expect(freshParams("for_each", EMPTY_DOCUMENT)).toEqual({ variable: "item", items: [] });
  expect(freshParams("ask", EMPTY_DOCUMENT)).toEqual({ answer: { type: "boolean" }, variable: "answer" });
  expect(freshParams("ask", DOCUMENT)?.variable).not.toBe("answer");
  expect(freshParams("notify", DOCUMENT)).toEqual({ level: "info" });
  expect(freshParams("on_event", DOCUMENT)).toEqual({ starts: "branch" });
  expect(freshParams("comment", DOCUMENT)).toEqual({ text: "" });
  expect(freshParams("wait", DOCUMENT)).toEqual({});
});

test("what needs a device, a place or a function is not put on the floor, nor is what is no kind of step", () => {
  const elsewhere = STEP_KINDS.map(({ kind }) => kind).filter((kind) => freshParams(kind, DOCUMENT) === null);
  expect(elsewhere).toEqual(["move", "pick", "drop", "pick_and_drop", "operate", "call"]);
  expect(freshParams("zone", DOCUMENT)).toBeNull();
});

test("a point in a frame or at an open branch says where the next step goes, any other one says nothing", () => {
  const box = { left: 100, top: 100, right: 200, bottom: 160 };
  const frames = [{ id: "loop", kind: "repeat", box, holds: new Set(), empty: true }];
  const end = { x: 400, y: 160 };
  const into = { parent: "choice", branch: "then" };
  const links = [{ id: "choice/then", points: [{ x: 400, y: 100 }, end], word: "true", to: null, into }];
  const open = { t: (key: string) => key, scene: { frames, links } } as unknown as OpenProgram;
  expect(goIntoAt(open, toMetres({ x: 300, y: 130 }))).toBe(false);
  expect(useUi.getState().into).toBeNull();
  expect(goIntoAt(open, toMetres({ x: 150, y: 130 }))).toBe(true);
  expect(useUi.getState().into?.branch).toEqual({ parent: "loop", branch: "body" });
  expect(goIntoAt(open, toMetres(end))).toBe(true);
  expect(useUi.getState().into?.branch).toEqual(into);
});

test("a tool that has its machines asks for none", () => {
  const task = { ...RESTING, tool: "pick_and_drop" };
  const held = [task, { ...task, source: "a" }, { ...task, source: "a", target: "b" }, { ...task, tool: "wait" }];
  expect(held.map(asksForDevice)).toEqual([true, true, false, false]);
});
