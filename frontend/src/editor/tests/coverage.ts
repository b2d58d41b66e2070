/** Which ways through a program its tests took, counted and in words. */
import type { TestCoverage } from "@/api/types";

export interface Missed {
  readonly step: string;
  readonly way: string;
}

export interface Figures {
  readonly steps: { readonly taken: number; readonly all: number };
  readonly ways: { readonly taken: number; readonly all: number };
}

const REACHED = "reached";
type Constructs = TestCoverage["constructs"];

export function figuresOf(constructs: Constructs): Figures {
  const counted = { steps: { taken: 0, all: 0 }, ways: { taken: 0, all: 0 } };
  for (const { ways } of constructs) {
    for (const [way, count] of Object.entries(ways)) {
      const of = way === REACHED ? counted.steps : counted.ways;
      of.all += 1;
      if (count > 0) of.taken += 1;
    }
  }
  return counted;
}

/** What no test took, in the order of the script; of a step that was never reached, that alone. */
export function missedOf(constructs: Constructs): Missed[] {
  return [...constructs]
    .sort((one, other) => one.line - other.line)
    .flatMap(({ step, ways }) => {
      if (ways[REACHED] === 0) return [{ step, way: REACHED }];
      return Object.entries(ways).flatMap(([way, count]) => (count === 0 ? [{ step, way }] : []));
    });
}

type Words = (key: string, values?: Record<string, unknown>) => string;

/** "its condition never held"; a catch names the kinds of failures that it takes. */
export function wordsOf(way: string, t: Words): string {
  const [kind, ...kinds] = way.split(" ");
  if (kind !== "catch") return t(`tests.missed.${way}`);
  return kinds.length > 0 ? t("tests.missed.catch_of", { kinds: kinds.join(", ") }) : t("tests.missed.catch");
}

/** For each step how many tests came there at most, and what of it none took. */
export function marksOf(constructs: Constructs): { step: string; tests: number; missed: string[] }[] {
  const missed = new Map<string, string[]>();
  for (const { step, way } of missedOf(constructs)) missed.set(step, [...(missed.get(step) ?? []), way]);
  return constructs.map(({ step, ways }) => ({
    step,
    tests: Math.max(0, ...Object.values(ways)),
    missed: missed.get(step) ?? [],
  }));
}

export interface Placed {
  readonly x: number;
  readonly y: number;
  readonly width: number;
}

const MARK_HIGH = 19;
const LIFTS = [0, 1, 2].map((rows) => rows * MARK_HIGH);

/** How far up each mark moves, in pixels at full size, so that it covers as little as can be of those before it. */
export function liftsOf(marks: readonly Placed[]): number[] {
  const done: Placed[] = [];
  return marks.map((mark) => {
    const costs = LIFTS.map((lift) =>
      done.reduce((sum, other) => sum + shared({ ...mark, y: mark.y - lift }, other), 0),
    );
    const lift = LIFTS[costs.indexOf(Math.min(...costs))] ?? 0;
    done.push({ ...mark, y: mark.y - lift });
    return lift;
  });
}

/** The area that two marks share, in square pixels. */
function shared(one: Placed, other: Placed): number {
  const wide = Math.min(one.x + one.width, other.x + other.width) - Math.max(one.x, other.x);
  const high = MARK_HIGH - Math.abs(one.y - other.y);
  return wide > 0 && high > 0 ? wide * high : 0;
}
