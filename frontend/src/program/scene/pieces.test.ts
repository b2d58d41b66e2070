import { expect, test } from "vitest";
import type { Chip } from "./chips";
import { areNear, detailAt } from "./detail";
import { boxAt } from "./geometry";
import { chipAt, chipsIn, lineAt, piecesOf, splitOver } from "./pieces";
import { SpatialIndex } from "./spatialIndex";

const chip = (id: string, x: number, y: number) =>
  ({ id, at: { x, y }, box: boxAt({ x, y }, 100, 28), shape: "pill", tagWidth: 0, problem: null }) as unknown as Chip;

const route = (step: string, ...points: { x: number; y: number }[]) => ({ step, points, guessed: false });

function scene(chips: readonly Chip[], more: Partial<Parameters<typeof piecesOf>[0]> = {}) {
  return piecesOf({
    chips: new Map(chips.map((each) => [each.id, each])),
    routes: [],
    links: [],
    frames: [],
    hulls: [],
    ...more,
  });
}

test("an index finds what touches a box, in the order in which it was given, and nothing twice", () => {
  const items = Array.from({ length: 2500 }, (_, at) => ({
    at,
    box: boxAt({ x: (at % 50) * 100, y: Math.floor(at / 50) * 100 }, 90, 90),
  }));
  const index = new SpatialIndex([...items, { at: -1, box: { left: -9000, right: 9000, top: -9000, bottom: 9000 } }]);
  const seen = { left: 230, right: 470, top: 180, bottom: 320 };
  expect(index.within(seen).map(({ at }) => at)).toEqual([102, 103, 104, 105, 152, 153, 154, 155, -1]);
  expect(index.within({ left: -99999, right: 99999, top: -99999, bottom: 99999 })).toHaveLength(2501);
  expect(index.within(boxAt({ x: 50, y: 50 }, 4, 4)).map(({ at }) => at)).toEqual([-1]);
});

test("a press finds the uppermost construct, and none beside it", () => {
  const pieces = scene([chip("under", 0, 0), chip("over", 40, 0), chip("far", 900, 900)]);
  expect([chipAt(pieces, { x: 20, y: 5 })?.id, chipAt(pieces, { x: -45, y: 5 })?.id]).toEqual(["over", "under"]);
  expect(chipAt(pieces, { x: 20, y: 15 })).toBeNull();
});

test("steps that drive the same way are one line, pressed within reach of it; one that is not known yet is none", () => {
  const points = [
    { x: 0, y: 0 },
    { x: 500, y: 0 },
  ];
  const pieces = scene([], {
    routes: [route("a", ...points), { ...route("b"), points }, { ...route("c", ...points), guessed: true }],
  });
  expect(pieces.lines.items.map(({ id }) => id)).toEqual(["route:a", "route:b", "route:c"]);
  const shared = scene([], {
    routes: [
      { step: "a", points, guessed: false },
      { step: "b", points, guessed: false },
    ],
  });
  expect(shared.lines.items.map(({ id }) => id)).toEqual(["route:a"]);
  expect([lineAt(shared, { x: 250, y: 7 }, 8)?.id, lineAt(shared, { x: 250, y: 9 }, 8)]).toEqual(["route:a", null]);
  expect(lineAt(scene([], { routes: [{ step: "c", points, guessed: true }] }), { x: 250, y: 0 }, 8)).toBeNull();
});

test("a box drawn to the right takes what lies in it, one drawn to the left what it touches", () => {
  const pieces = scene([chip("inside", 100, 100), chip("cut", 190, 100), chip("outside", 500, 100)]);
  const drawn = { left: 40, right: 200, top: 60, bottom: 140 };
  expect([chipsIn(pieces, drawn, false), chipsIn(pieces, drawn, true)]).toEqual([["inside"], ["inside", "cut"]]);
});

test("what stands on a machine is painted over it, all else below", () => {
  const pieces = scene([chip("beside", 0, 0), chip("docked", 300, 0), chip("far", 900, 0)]);
  const { below, over } = splitOver(pieces, [boxAt({ x: 380, y: 0 }, 80, 80)]);
  expect(below.chips.items.map(({ id }) => id)).toEqual(["beside", "far"]);
  expect(over.chips.items.map(({ id }) => id)).toEqual(["docked"]);
  expect(splitOver(pieces, []).below).toBe(pieces);
});

test("constructs are elements while they can be read and are few; those that are, do not turn at the first one more", () => {
  expect([0.2, 0.4, 0.6, 1].map(detailAt)).toEqual(["dot", "icon", "full", "full"]);
  expect([areNear(1, 80, false), areNear(1, 81, false), areNear(1, 81, true), areNear(1, 101, true)]).toEqual([
    true,
    false,
    true,
    false,
  ]);
  expect(areNear(0.3, 1, true)).toBe(false);
});
