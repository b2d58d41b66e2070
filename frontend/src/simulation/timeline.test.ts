import { describe, expect, it } from "vitest";
import { clock, tickEvery } from "@/design/clock";
import { markerPlaces, neighbour, segmentsOf, statusesAt, stepStarts, type StepSpan } from "./timeline";

const span = (step: string, started_s: number, ended_s: number | null, status = "done"): StepSpan => ({
  step,
  count: 1,
  robot: null,
  device: null,
  started_s,
  ended_s,
  status,
});

describe("segmentsOf", () => {
  it("puts what follows on one lane and what overlaps below", () => {
    const spans = [span("a", 0, 10), span("b", 10, 20), span("c", 5, 12), span("inner", 1, 2)];
    expect(segmentsOf(spans, new Set(["a", "b", "c"]), 30)).toEqual([
      { step: "a", started_s: 0, ended_s: 10, lane: 0 },
      { step: "c", started_s: 5, ended_s: 12, lane: 1 },
      { step: "b", started_s: 10, ended_s: 20, lane: 0 },
    ]);
  });

  it("draws a step that never ended to the end", () => {
    expect(segmentsOf([span("a", 3, null)], new Set(["a"]), 9)[0]?.ended_s).toBe(9);
  });
});

describe("neighbour", () => {
  const moments = stepStarts([span("b", 7, 8), span("a", 2, 7), span("c", 2, 3)]);
  it("finds the next one", () => expect(neighbour(moments, 2, 1, 10)).toBe(7));
  it("finds the one before", () => expect(neighbour(moments, 7, -1, 10)).toBe(2));
  it("goes to the ends", () => {
    expect(neighbour(moments, 8, 1, 10)).toBe(10);
    expect(neighbour(moments, 1, -1, 10)).toBe(0);
  });
});

describe("statusesAt", () => {
  const spans = [span("a", 0, 4), span("b", 4, 6, "failed"), span("a", 6, 9)];
  it("tells waiting, running and failed", () => {
    expect(statusesAt(spans, 3)).toEqual({ a: "running", b: "waiting" });
    expect(statusesAt(spans, 5)).toEqual({ a: "done", b: "running" });
    expect(statusesAt(spans, 7)).toEqual({ a: "running", b: "failed" });
    expect(statusesAt(spans, 10)).toEqual({ a: "done", b: "failed" });
    expect(statusesAt([span("c", 0, 4, "skipped")], 5)).toEqual({ c: "skipped" });
  });
});

describe("clock and ticks", () => {
  it("writes times", () => expect([clock(0), clock(66.9), clock(3700)]).toEqual(["0:00", "1:06", "1:01:40"]));
  it("keeps ticks apart", () => expect([tickEvery(60), tickEvery(1668)]).toEqual([10, 300]));
});

describe("the marks above the track", () => {
  it("stand at their moments, and beside each other where they would lie over each other", () => {
    expect(markerPlaces([40, 300, 305, 500])).toEqual([40, 300, 320, 500]);
  });

  it("are moved only so far: many at one moment do not end up elsewhere", () => {
    expect(markerPlaces([100, 100, 100, 100])).toEqual([100, 120, 140, 140]);
  });
});
