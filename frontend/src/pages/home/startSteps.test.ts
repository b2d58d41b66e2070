import { expect, test } from "vitest";
import { mayDo, startSteps, whereTo } from "./startSteps";

const NOTHING = { hasMap: false, places: 0, devices: 0, programs: 0 };
const done = (known: Partial<typeof NOTHING>) =>
  startSteps({ ...NOTHING, ...known })
    .filter((step) => step.done)
    .map((step) => step.key);

test("an empty site has everything before it, in order", () => {
  expect(startSteps(NOTHING).map((step) => step.key)).toEqual(["map", "places", "devices", "program"]);
  expect(done({})).toEqual([]);
});

test("each step is done by what the site really has, in whatever order it came", () => {
  expect(done({ hasMap: true, programs: 1 })).toEqual(["map", "program"]);
  expect(done({ hasMap: true, places: 2, devices: 1, programs: 1 })).toHaveLength(4);
});

test("admins do all, authors draw, others are told who does", () => {
  const [map, , , program] = startSteps(NOTHING);
  if (!map || !program) throw new Error("There are four steps.");
  expect([mayDo("admin", map), mayDo("author", map), mayDo("viewer", map)]).toEqual([true, false, false]);
  expect([mayDo("author", program), mayDo("operator", program), mayDo(undefined, program)]).toEqual([
    true,
    false,
    false,
  ]);
});

test("each step opens the screen on which it is done", () => {
  expect([whereTo("hall", "map"), whereTo("hall", "places"), whereTo("hall", "devices")]).toEqual([
    "/sites/hall/map/new",
    "/sites/hall/map?places",
    "/sites/hall/devices",
  ]);
});
