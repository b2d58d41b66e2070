import { expect, test } from "vitest";
import type { Thread } from "@/api/types";
import { toPixels } from "@/map/plane/projection";
import type { OpenProgram } from "../state/context";
import { gatherPins, levelOf, pinsOf } from "./pins";

const AT = "2026-01-02T03:04:00Z";
const NOWHERE = { root: null, id: null, to: null, x: null, y: null, run: null, number: null, t_s: null };

function thread(id: string, anchor: Partial<Thread["anchor"]>, changes: Partial<Thread> = {}): Thread {
  return {
    id,
    anchor: { kind: "program", ...NOWHERE, ...anchor },
    label: "",
    stands: true,
    started_at: AT,
    resolved_at: null,
    resolved_by: null,
    comments: [],
    unread: 0,
    ...changes,
  };
}

const onStep = (step: string, x: number | null = null, y: number | null = null) =>
  ({ kind: "construct", root: "steps", id: step, x, y }) as const;

/** A drawing with steps at these corners, pixels, and an arrow from a to b. */
function drawn(corners: Readonly<Record<string, readonly [number, number]>>): Pick<OpenProgram, "document" | "scene"> {
  const chips = Object.entries(corners).map(([id, [left, top]]) => [id, { box: { left, top } }]);
  const points = [
    { x: 0, y: 0 },
    { x: 30, y: 0 },
    { x: 30, y: 70 },
  ];
  return {
    document: { steps: corners },
    scene: { chips: new Map(chips as never), links: [{ from: "a", to: "b", points }] },
  } as unknown as Pick<OpenProgram, "document" | "scene">;
}

test("each commented step has one pin, with its open threads and what is unread of them", () => {
  const open = drawn({ a: [10, 20], b: [300, 20] });
  const threads = [
    thread("1", onStep("a"), { unread: 2 }),
    thread("2", onStep("b")),
    thread("3", onStep("a"), { unread: 1 }),
    thread("4", onStep("a"), { resolved_at: AT }),
    thread("5", {}),
  ];
  expect(pinsOf(threads, open)).toEqual([
    { key: "a", at: { x: 10, y: 20 }, threads: ["1", "3"], unread: 3, steps: ["a"], things: 1 },
    { key: "b", at: { x: 300, y: 20 }, threads: ["2"], unread: 0, steps: ["b"], things: 1 },
  ]);
});

test("what was deleted keeps its pin where it was; a step that is drawn in no view has none", () => {
  const open = drawn({ a: [10, 20] });
  const hidden = { ...open, scene: { ...open.scene, chips: new Map() } };
  const gone = thread("1", onStep("gone", 1, 2));
  const [pin] = pinsOf([gone], open);
  expect([pin?.steps, pin?.at]).toEqual([[], toPixels([1, 2])]);
  expect(pinsOf([thread("2", onStep("a", 1, 2))], hidden)).toEqual([]);
});

test("an arrow has its pin midway, a place where it is", () => {
  const open = drawn({ a: [0, 0], b: [30, 70] });
  const threads = [thread("1", { kind: "arrow", id: "a", to: "b" }), thread("2", { kind: "place", x: 3, y: 1 })];
  expect(pinsOf(threads, open).map(({ at }) => ({ x: at.x, y: at.y }))).toEqual([{ x: 30, y: 20 }, toPixels([3, 1])]);
});

test("pins that would lie on each other are one, which parts when the map comes nearer", () => {
  const open = drawn({ a: [10, 20], b: [50, 20], c: [600, 20] });
  const pins = pinsOf(
    [thread("1", onStep("a"), { unread: 1 }), thread("2", onStep("b")), thread("3", onStep("c"))],
    open,
  );
  expect(gatherPins(pins, 1)).toEqual(pins);
  expect(gatherPins(pins, 0.25)).toEqual([
    { key: "a", at: { x: 10, y: 20 }, threads: ["1", "2"], unread: 1, steps: ["a", "b"], things: 2 },
    pins[2],
  ]);
});

test("among two thousand steps only the threads are looked at", () => {
  const corners = Object.fromEntries(Array.from({ length: 2000 }, (_, at) => [`s${at}`, [at * 5, at] as const]));
  const open = drawn(corners);
  let looks = 0;
  const chips = { get: (id: string) => (looks++, open.scene.chips.get(id)) };
  const threads = Array.from({ length: 300 }, (_, at) => thread(String(at), onStep(`s${at}`)));
  const pins = pinsOf(threads, { ...open, scene: { ...open.scene, chips } as never });
  expect([pins.length, looks]).toEqual([300, 300]);
  expect(gatherPins(pins, 0.2).length).toBeLessThan(20);
});

test("a map that is zoomed a little gathers as before", () => {
  expect([0.95, 1, 1.1].map(levelOf)).toEqual([1, 1, 1]);
  expect(levelOf(0.25)).toBe(0.25);
});
