import { expect, test } from "vitest";
import type { Palette } from "@/map/plane/palette";
import type { Chip } from "../scene/chips";
import { faceColours } from "./chipFaces";
import type { StepState } from "./looks";

/** Every colour is called by its own name. */
const NAMED = new Proxy({}, { get: (_all, name) => name }) as Palette;

function coloursOf(state: StepState, more: Partial<Chip> = {}) {
  const chip = { shape: "pill", family: "motion", problem: null, inner: false, ...more } as Chip;
  const { border, line, body, badge } = faceColours(NAMED, chip, state);
  return { border, line, body, badge };
}

test("what differs between two documents is edged as its kind of change, and keeps its family's number", () => {
  expect(coloursOf("added")).toEqual({ border: "done", line: "motion", body: "done-soft", badge: "motion" });
  expect(coloursOf("changed")).toEqual({ border: "brand", line: "motion", body: "panel", badge: "motion" });
  expect(coloursOf("moved")).toEqual({ border: "machine", line: "motion", body: "panel", badge: "motion" });
  expect(coloursOf("removed")).toEqual({ border: "error", line: "error", body: "error-soft", badge: "error" });
});

test("what is the same, or is wrong in a program that is compared, keeps its own colours", () => {
  const own = { border: "motion", line: "motion", body: "panel", badge: "motion" };
  expect(coloursOf("same", { problem: "error" })).toEqual(own);
});

test("a finding edges a construct while no state does, and leaves its number alone", () => {
  expect(coloursOf(null, { problem: "error" })).toMatchObject({ border: "error", badge: "motion" });
  expect(coloursOf("done", { problem: "error" })).toMatchObject({ border: "done", badge: "done-soft" });
});
