import { expect, test } from "vitest";
import type { FloorPlan } from "@/map/floor/floor";
import { EMPTY_DOCUMENT } from "../document/document";
import { buildScene } from "../scene/scene";
import { surroundingsOf, type SiteDevice } from "../surroundings";
import { placeLabels } from "./buildNodes";

const oven = {
  id: "oven",
  name: "Oven",
  kind: "machine",
  device_class: "oven",
  status: "idle",
  doing: "",
  location: { x: 5, y: -5, theta: 0 },
  size: { x: 1, y: 1 },
  methods: [],
  properties: [],
  gives: [],
  takes: [],
} as unknown as SiteDevice;

/** Ten metres by ten, with a wall along one row; rows count from the bottom. */
function hall(wall: number | null): FloorPlan {
  const cells = new Uint8Array(100).map((_, index) => (Math.floor(index / 10) === wall ? 100 : 0));
  return { version: 1, width: 10, height: 10, resolution_m: 1, origin: { x: 0, y: -10 }, places: [], cells };
}

function sideOfName(plan: FloorPlan): unknown {
  const scene = buildScene({
    document: EMPTY_DOCUMENT,
    compiled: null,
    surroundings: surroundingsOf([oven], []),
    floor: null,
    routes: () => undefined,
    collapsed: new Set(),
    t: (key) => key,
    measure: (text) => text.length * 7,
  });
  return placeLabels(scene, [oven], plan).get("oven")?.side;
}

test("a machine's name does not stand on the wall below it", () => {
  expect(sideOfName(hall(null))).toBe("below");
  expect(sideOfName(hall(3))).toBe("above");
});
