import { expect, test } from "vitest";
import type { Palette } from "@/map/plane/palette";
import { seenBox } from "@/map/plane/projection";
import type { Chip } from "../scene/chips";
import { boxAt } from "../scene/geometry";
import { piecesOf } from "../scene/pieces";
import { resolved } from "./looks";
import { markOf } from "./marks";
import { type Content, covers, unitsOf, work } from "./picture";

const chip = (id: string, x: number, y: number) =>
  ({ id, at: { x, y }, box: boxAt({ x, y }, 100, 28), shape: "pill", tagWidth: 0 }) as unknown as Chip;

/** A field of so many constructs, 200 apart in rows of 50. */
function field(count: number, without: readonly string[] = []): Content {
  const chips = Array.from({ length: count }, (_, at) => chip(`s${at}`, (at % 50) * 200, Math.floor(at / 50) * 200));
  const scene = { chips: new Map(chips.map((each) => [each.id, each])), routes: [], links: [], frames: [], hulls: [] };
  return { pieces: piecesOf(scene), looks: {} as Content["looks"], without: new Set(without), palette: {} as Palette };
}

const PANE = { width: 1600, height: 1000 };
const HERE = { x: 0, y: 0, zoom: 1 };

test("what is painted at zoom 1 is what is in view, however many there are besides", () => {
  const [few, many] = [field(500), field(2000)].map((content) => unitsOf(content, seenBox(HERE, PANE), 1));
  expect(few).toBe(54); // nine columns, six rows
  expect(many).toBe(54);
  expect(unitsOf(field(2000, ["s0", "s1"]), seenBox(HERE, PANE), 1)).toBe(52);
});

test("with all in view a construct costs a sixth of what it does with its words", () => {
  const whole = { x: 0, y: 0, zoom: 0.12 };
  expect(unitsOf(field(2000), seenBox(whole, PANE), whole.zoom)).toBeCloseTo(2000 * 0.15);
});

test("a picture is painted in slices of bounded work", () => {
  let painted = 0;
  function* job() {
    for (; painted < 2000; painted += 1) yield 1;
  }
  const slices = job();
  const after: number[] = [];
  while (!work(slices, 150)) after.push(painted);
  expect(after.slice(0, 3)).toEqual([149, 299, 449]);
  expect(after).toHaveLength(13);
  expect(painted).toBe(2000);
});

test("a picture serves for views of its zoom within its margin", () => {
  expect(covers(HERE, { x: 100, y: -100, zoom: 1 }, 128)).toBe(true);
  expect(covers(HERE, { x: 129, y: 0, zoom: 1 }, 128)).toBe(false);
  expect(covers(HERE, { x: 0, y: 0, zoom: 1.1 }, 128)).toBe(false);
});

test("how a step fares has a mark of its own shape; before a run it is what was found", () => {
  expect([markOf("error", null), markOf("warning", null), markOf("error", "planned")]).toEqual(["failed", null, null]);
  expect([markOf(null, "running"), markOf(null, "done"), markOf(null, "failed")]).toEqual([
    "running",
    "done",
    "failed",
  ]);
});

test("colours of styles are those of the palette", () => {
  const palette = { busy: "#123456" } as Palette;
  expect([resolved(palette, "var(--busy)"), resolved(palette, "#abcdef")]).toEqual(["#123456", "#abcdef"]);
});
