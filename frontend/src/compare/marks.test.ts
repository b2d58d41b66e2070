import { expect, test } from "vitest";
import type { ConstructChange, Difference } from "@/api/types";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { buildScene, type Scene } from "@/program/scene/scene";
import { surroundingsOf } from "@/program/surroundings";
import en from "@/i18n/en/editor.json";
import { drawnScene, ghostsOf, mergedParts, neighbour, spotOf, tilesOf } from "./marks";

/** The templates of chips in English. */
const CHIPS = en.chip as Record<string, string>;

const wait = (order: string, pos: [number, number], duration: number): Step => ({
  kind: "wait",
  place: ["program", "body", order],
  pos,
  params: { duration },
});

function sceneOf(steps: Record<string, Step>): Scene {
  const document: ProgramDocument = { ...EMPTY_DOCUMENT, steps };
  const t = (key: string, values: Record<string, unknown> = {}) =>
    CHIPS[key.replace(/^chip\./, "")]?.replace(/\{\{(\w+)\}\}/g, (_, name: string) => String(values[name])) ?? key;
  const surroundings = surroundingsOf([], []);
  const numbers = Object.fromEntries(Object.keys(steps).map((id, at) => [id, String(at + 1)]));
  const compiled = { numbers, diagnostics: [], added_moves: [] };
  return buildScene({
    document,
    compiled,
    surroundings,
    floor: null,
    routes: () => undefined,
    collapsed: new Set(),
    t,
    measure: (text) => text.length * 7,
  });
}

const change = (id: string, kind: ConstructChange["kind"]): ConstructChange => ({
  root: "steps",
  id,
  kind,
  moved: kind === "moved",
  changes: [],
});
const OLD = sceneOf({
  same: wait("A", [1, -1], 60),
  gone: wait("B", [5, -1], 60),
  there: wait("C", [9, -1], 60),
  more: wait("D", [2, -5], 60),
});
const NEXT = sceneOf({
  same: wait("A", [1, -1], 60),
  there: wait("Z", [3, -3], 60),
  more: wait("D", [2, -5], 120),
  fresh: wait("Y", [8, -8], 60),
});
const FOUND: Difference = {
  constructs: [
    change("gone", "removed"),
    change("there", "moved"),
    change("more", "changed"),
    change("fresh", "added"),
  ],
  tidied: [],
  same: 1,
};
const measure = (text: string) => text.length * 7;

test("what is removed stays as a ghost at its old place, what has moved points to its new one", () => {
  const ghosts = ghostsOf("both", OLD, NEXT, FOUND);
  expect(ghosts.map((ghost) => [ghost.kind, ghost.chip.id, ghost.to])).toEqual([
    ["removed", "gone", null],
    ["moved", "there", NEXT.chips.get("there")?.at],
  ]);
  expect(ghosts[0]?.chip.at).toEqual(OLD.chips.get("gone")?.at);
  expect([ghostsOf("old", OLD, NEXT, FOUND), ghostsOf("new", OLD, NEXT, FOUND)]).toEqual([[], []]);
});

test("every change of a step has a tile where it is drawn, and on one side alone those of that side", () => {
  const tiles = (shown: "old" | "both" | "new") =>
    tilesOf(drawnScene(shown, OLD, NEXT, FOUND, measure), ghostsOf(shown, OLD, NEXT, FOUND), FOUND).map(
      (tile) => tile.key,
    );
  expect(tiles("both")).toEqual(["steps/gone", "steps/there", "steps/more", "steps/fresh"]);
  expect(tiles("old")).toEqual(["steps/gone", "steps/there", "steps/more"]);
  expect(tiles("new")).toEqual(["steps/there", "steps/more", "steps/fresh"]);
});

test("a changed chip says the old value before the new one and is as wide as both", () => {
  const drawn = drawnScene("both", OLD, NEXT, FOUND, measure);
  const [before, after] = [NEXT.chips.get("more"), drawn.chips.get("more")];
  expect(after?.parts.filter((part) => part.tone === "old").map((part) => part.text)).toEqual(["wait 1\u202fmin"]);
  expect(after?.width).toBeGreaterThan(before?.width ?? Infinity);
  expect(drawn.chips.get("same")).toBe(NEXT.chips.get("same"));
});

test("words that are the same are said once, and chips of other words are not mixed", () => {
  const plain = (text: string) => ({ text, tone: "plain" as const });
  expect(mergedParts([plain("2"), plain("box")], [plain("1"), plain("box")])).toEqual([
    { text: "2", tone: "old" },
    plain("1"),
    plain("box"),
  ]);
  expect(mergedParts([plain("2")], [plain("1"), plain("box")])).toEqual([plain("1"), plain("box")]);
});

test("what has no place on the map has no spot there, what is gone has its old one", () => {
  expect(spotOf({ ...change("f", "changed"), root: "functions" }, OLD, NEXT)).toBeNull();
  expect(spotOf(change("gone", "removed"), OLD, NEXT)).toEqual(OLD.chips.get("gone")?.at);
});

test("walking begins at either end and goes round", () => {
  const keys = ["a", "b", "c"];
  expect([neighbour(keys, null, 1), neighbour(keys, null, -1)]).toEqual(["a", "c"]);
  expect([neighbour(keys, "a", 1), neighbour(keys, "c", 1), neighbour(keys, "a", -1)]).toEqual(["b", "a", "c"]);
  expect(neighbour([], null, 1)).toBeNull();
});
