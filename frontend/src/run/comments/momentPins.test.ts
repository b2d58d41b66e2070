import { expect, test } from "vitest";
import type { Thread } from "@/api/types";
import { momentAfter } from "./MomentScale";
import { pinsOnTimeline } from "./momentPins";

const at = (t_s: number, changes: Partial<Thread> = {}) => ({
  t_s,
  thread: { id: String(t_s), resolved_at: null, unread: 1, ...changes } as Thread,
});

test("near moments have one pin, resolved ones none", () => {
  const pins = pinsOnTimeline([at(10), at(11), at(12, { resolved_at: "2026-01-01" }), at(50)], 60);
  expect(pins.map((pin) => [pin.t_s, pin.threads.map(({ id }) => id), pin.unread])).toEqual([
    [10, ["10", "11"], 2],
    [50, ["50"], 1],
  ]);
  expect(pinsOnTimeline([at(10), at(11)], 20)).toHaveLength(2);
});

test("three hundred threads within a second are one pin, and spread over a run at most thirty", () => {
  expect(
    pinsOnTimeline(
      Array.from({ length: 300 }, (_, i) => at(5 + i / 300)),
      60,
    ),
  ).toHaveLength(1);
  expect(
    pinsOnTimeline(
      Array.from({ length: 300 }, (_, i) => at(i)),
      300,
    ).length,
  ).toBeLessThanOrEqual(30);
});

test("keys lead along the run and never beyond it", () => {
  const press = (key: string, now: number, shiftKey = false) => momentAfter({ key, shiftKey }, now, 30);
  expect([press("ArrowLeft", 0.4), press("ArrowRight", 5), press("ArrowRight", 25, true)]).toEqual([0, 6, 30]);
  expect([press("Home", 5), press("End", 5), press("PageUp", 5), press("a", 5)]).toEqual([0, 30, 15, null]);
});
