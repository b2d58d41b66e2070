/** How the constructs that hold others are drawn: frames, ways out, roots, notes, and how they are told. */
import { expect, test } from "vitest";
import en from "@/i18n/en/editor.json";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "../document/document";
import { chipLabel } from "./announcements";
import type { Box } from "@/map/plane/projection";
import { buildScene, type Scene } from "./scene";
import { surroundingsOf } from "../surroundings";

const CHIPS = en.chip as Record<string, string>;
/** The templates of chips in English; other texts as their key, with what is filled in. */
const t = (key: string, values: Record<string, unknown> = {}) =>
  CHIPS[key.replace(/^chip\./, "")]?.replace(/\{\{(\w+)\}\}/g, (_, name: string) => String(values[name])) ??
  [key, ...Object.values(values)].join(" ");
const surroundings = surroundingsOf([], []);

function step(kind: string, place: Step["place"], pos: [number, number], params: Step["params"] = {}): Step {
  return { kind, place, pos, params };
}

function sceneOf(
  steps: Record<string, Step>,
  numbers: Record<string, string> = {},
  floor: Box | null = null,
): [Scene, ProgramDocument] {
  const document = { ...EMPTY_DOCUMENT, steps };
  const scene = buildScene({
    document,
    compiled: { numbers, diagnostics: [], added_moves: [] },
    surroundings,
    floor,
    routes: () => undefined,
    collapsed: new Set(),
    t,
    measure: (text) => text.length * 7,
  });
  return [scene, document];
}

function linkTo(scene: Scene, id: string) {
  return scene.links.find((link) => link.id === id);
}

test.each(["while", "repeat", "for_each", "try", "limit"])(
  "the frame of a %s goes around the steps beside its head",
  (kind) => {
    const [scene] = sceneOf({
      head: step(kind, ["program", "body", "A"], [5, -3]),
      near: step("notify", ["head", "body", "A"], [5, -4]),
      far: step("notify", ["head", "body", "B"], [15, -9]),
    });
    const [frame] = scene.frames;
    expect([...(frame?.holds ?? [])]).toEqual(["near"]);
    const near = scene.chips.get("near")?.box;
    expect(frame && near && frame.box.left < near.left && frame.box.bottom > near.bottom).toBe(true);
  },
);

test("loops in loops: the outer frame goes around the inner one", () => {
  const [scene] = sceneOf({
    outer: step("repeat", ["program", "body", "A"], [5, -3]),
    inner: step("for_each", ["outer", "body", "A"], [5, -4]),
    told: step("notify", ["inner", "body", "A"], [5, -5]),
  });
  const box = (id: string) => scene.frames.find((frame) => frame.id === id)?.box;
  const [outer, inner] = [box("outer"), box("inner")];
  expect(outer && inner && outer.left < inner.left && outer.bottom > inner.bottom).toBe(true);
});

test("a try offers its catch; a finally only where one is wanted", () => {
  const plain = sceneOf({ head: step("try", ["program", "body", "A"], [5, -3]) })[0];
  expect([linkTo(plain, "head/catch")?.word, linkTo(plain, "head/finally")]).toEqual(["branch.catch", undefined]);
  const full = sceneOf({ head: step("try", ["program", "body", "A"], [5, -3], { finally: true, catch: false }) })[0];
  expect([linkTo(full, "head/catch"), linkTo(full, "head/finally")?.word]).toEqual([undefined, "branch.finally"]);
});

test("each of several catches is offered, and its arrow says what it takes", () => {
  const params = { kinds: ["timed_out", "blocked"], kinds3: ["offline"], kinds8: [] };
  const scene = sceneOf({ head: step("try", ["program", "body", "A"], [5, -3], params) })[0];
  const words = ["catch", "catch2", "catch3", "catch8"].map((branch) => linkTo(scene, `head/${branch}`)?.word);
  expect(words).toEqual(["caught.timed_out +1", undefined, "caught.offline", "caught.rest"]);
  expect(linkTo(scene, "head/catch8")?.tone).toBe("catch");
});

test("catch and finally leave a try beside each other", () => {
  const [scene] = sceneOf({
    head: step("try", ["program", "body", "A"], [5, -3]),
    mend: step("notify", ["head", "catch", "A"], [3, -8]),
    last: step("notify", ["head", "finally", "A"], [8, -8]),
  });
  const exit = (id: string) => linkTo(scene, id)?.points[0]?.x ?? 0;
  expect(exit("head/catch")).toBeLessThan(exit("head/finally"));
  expect([linkTo(scene, "head/catch")?.tone, linkTo(scene, "head/finally")?.tone]).toEqual(["catch", "branch"]);
});

test("an event is a root of its own: no arrow leads to it, and its arrow needs no word", () => {
  const [scene] = sceneOf({
    first: step("notify", ["program", "body", "A"], [3, -3]),
    hot: step("on_event", ["program", "events", "A"], [8, -3]),
    told: step("notify", ["hot", "body", "A"], [8, -5]),
  });
  expect(scene.chips.get("hot")?.shape).toBe("root");
  expect(scene.links.map((link) => [link.id, link.to, link.word])).toEqual([
    ["start", "first", null],
    ["hot/body", "told", null],
  ]);
});

test("a comment is a note on the map and no draft", () => {
  const [scene] = sceneOf({ note: step("comment", null, [3, -3], { text: "Keep 2 cans" }) });
  expect(scene.chips.get("note")).toMatchObject({ shape: "note", family: "note", draft: false, number: "" });
  expect(scene.tree.drafts).toEqual([]);
});

test("Start stands where no chip covers it", () => {
  const startWith = (steps: Record<string, Step>) => sceneOf(steps)[0].start;
  const usual = startWith({});
  const moved = startWith({ ask: step("comment", null, [1, -1], { text: "Here" }) });
  expect([moved.y, moved.x > usual.x]).toEqual([usual.y, true]);
  expect(startWith({ ask: step("comment", null, [1, -6], { text: "Elsewhere" }) })).toEqual(usual);
});

test("a step is told with where it stands", () => {
  const [scene, document] = sceneOf(
    {
      head: step("repeat", ["program", "body", "A"], [5, -3], { times: 3 }),
      set: step("set", ["head", "body", "A"], [5, -4], { variable: "x", value: 3 }),
    },
    { head: "4", set: "4a" },
  );
  const chip = scene.chips.get("set");
  expect(chip && chipLabel(chip, { document, surroundings, t })).toBe(
    "4a, kind.set, x = 3, announce.inside kind.repeat 4",
  );
});

test("the name of a kind is not told twice", () => {
  const [scene, document] = sceneOf({
    loop: step("repeat", ["program", "body", "A"], [5, -3], { times: 3 }),
    over: step("end", ["program", "body", "B"], [5, -8]),
  });
  const told = ["loop", "over"].map((id) => {
    const chip = scene.chips.get(id);
    return chip && chipLabel(chip, { document, surroundings, t });
  });
  expect(told).toEqual(["kind.repeat, 3 ×", "kind.end"]);
});

test("the start and steps without a place stand on the floor, wherever the map has its origin", () => {
  const placeless = { kind: "wait", place: ["program", "body", "A"], params: { duration: 1 } } as const;
  const spots = (floor: Box | null) => {
    const [scene] = sceneOf({ some: placeless }, {}, floor);
    return [scene.start, scene.chips.get("some")?.at];
  };
  const usual = spots(null);
  expect(usual[1]).toEqual({ x: 46, y: 46 });
  expect(spots({ left: -460, right: 920, top: -230, bottom: 644 })).toEqual(usual);
  const far = { left: 46_000_000, right: 46_000_920, top: -23_000_000, bottom: -22_999_356 };
  expect(spots(far)).toEqual(usual.map((spot) => spot && { x: spot.x + far.left, y: spot.y + far.top }));
});
