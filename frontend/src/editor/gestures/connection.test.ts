import { expect, test } from "vitest";
import { START_ID } from "@/program/canvas/buildNodes";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import type { Chip } from "@/program/scene/chips";
import { boxAt } from "@/program/scene/geometry";
import { joinTarget } from "@/program/canvas/snapping";
import { readTree } from "@/program/document/tree";
import { applyEdits, type Edit } from "../edits/edits";
import type { OpenProgram } from "../state/context";
import { useGestures } from "../state/gestures";
import { decideJoin, joinByDot } from "./connection";

const chip = (id: string, x: number) =>
  [id, { id, at: { x, y: 0 }, box: boxAt({ x, y: 0 }, 100, 28) } as Chip] as const;
const chips = new Map([chip("a", 0), chip("b", 140)]);

test("an arrow snaps to the nearest step within 24 pixels of the screen", () => {
  expect(joinTarget(chips, START_ID, { x: 0, y: 37 }, 1)).toBe("a");
  expect(joinTarget(chips, START_ID, { x: 0, y: 39 }, 1)).toBeNull();
  expect(joinTarget(chips, START_ID, { x: 0, y: 37 }, 2)).toBeNull();
  expect(joinTarget(chips, START_ID, { x: 72, y: 0 }, 1)).toBe("b");
});

test("an arrow never leads back into its own step", () => {
  expect(joinTarget(chips, "a", { x: 0, y: 0 }, 1)).toBeNull();
});

test("an arrow out of the start makes its step the first", () => {
  const step = (order: string) => ({ kind: "wait", place: ["program", "body", order] as const, pos: null, params: {} });
  const document: ProgramDocument = { ...EMPTY_DOCUMENT, steps: { a: step("A"), b: step("B") } };
  const decision = decideJoin(document, START_ID, "b");
  expect("edits" in decision && decision.edits.map((edit) => "id" in edit && edit.id)).toEqual(["b"]);
  expect(decideJoin(document, "a", "b")).toHaveProperty("edits");
});

test("a branch that is chosen for an arrow is one of the program as it is then", () => {
  const step = (kind: string, order: string): Step => {
    return { kind, place: ["program", "body", order], pos: null, params: {} };
  };
  let document: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    steps: { hot: step("if", "A"), wait: step("wait", "B"), last: step("wait", "C") },
  };
  const said: string[] = [];
  const open = () => {
    const apply = (edits: readonly Edit[]) => (document = applyEdits(document, edits));
    return { document, apply, t: (key: string) => (said.push(key), key) } as unknown as OpenProgram;
  };
  const choose = (id: string, meanwhile: Edit) => {
    joinByDot(open(), "hot", "last", { x: 0, y: 0 });
    document = applyEdits(document, [meanwhile]);
    useGestures
      .getState()
      .menu?.items.find((each) => each.id === id)
      ?.run(open());
  };
  choose("then", { do: "set_place", id: "wait", place: ["hot", "then", "A"] });
  expect(readTree(document).children("hot", "then").toSorted()).toEqual(["last", "wait"]);
  expect(document.steps.last?.place?.[2]).not.toBe(document.steps.wait?.place?.[2]);
  choose("else", { do: "remove_step", id: "hot" });
  expect(document.steps.last?.place?.slice(0, 2)).toEqual(["hot", "then"]);
  expect(said).toContain("refused.gone");
});
