/** The bar of top-level steps under the scene, and the moments one can jump to. */

export interface StepSpan {
  step: string;
  count: number;
  robot: string | null;
  device: string | null;
  started_s: number;
  ended_s: number | null;
  status: string;
}

export interface Segment {
  step: string;
  started_s: number;
  ended_s: number;
  lane: number;
}

/**
 * Lay the program's top-level steps on lanes in the order of their beginning, so that two that overlap lie
 * below each other. A step that ran several times gives several segments.
 */
export function segmentsOf(spans: readonly StepSpan[], topLevel: ReadonlySet<string>, duration_s: number): Segment[] {
  const free: number[] = [];
  return spans
    .filter((span) => topLevel.has(span.step))
    .map((span) => ({ step: span.step, started_s: span.started_s, ended_s: span.ended_s ?? duration_s }))
    .sort((a, b) => a.started_s - b.started_s)
    .map((span) => {
      const found = free.findIndex((end) => end <= span.started_s + 1e-6);
      const lane = found === -1 ? free.length : found;
      free[lane] = span.ended_s;
      return { ...span, lane };
    });
}

/** Every moment at which a step begins, without repeats, in order. */
export function stepStarts(spans: readonly StepSpan[]): number[] {
  return [...new Set(spans.map((span) => span.started_s))].sort((a, b) => a - b);
}

/** The next moment in a list after `t_s` (or before it), or the list's end in that direction. */
export function neighbour(moments: readonly number[], t_s: number, direction: 1 | -1, end_s: number): number {
  if (direction === 1) return moments.find((moment) => moment > t_s + 0.05) ?? end_s;
  return [...moments].reverse().find((moment) => moment < t_s - 0.05) ?? 0;
}

/** The status of every step at a moment: the latest of its spans that has begun counts. */
export function statusesAt(
  spans: readonly StepSpan[],
  t_s: number,
): Record<string, "waiting" | "running" | "done" | "failed" | "skipped"> {
  const statuses: Record<string, "waiting" | "running" | "done" | "failed" | "skipped"> = {};
  for (const span of spans) {
    if (span.started_s > t_s) {
      statuses[span.step] ??= "waiting";
      continue;
    }
    const over = span.ended_s !== null && span.ended_s <= t_s;
    if (!over) statuses[span.step] = "running";
    else if (statuses[span.step] !== "running") statuses[span.step] = endedAs(span);
  }
  return statuses;
}

/** How a step that is over has ended; one that was called off with its branch was not done. */
function endedAs({ status }: StepSpan): "done" | "failed" | "skipped" {
  return status === "failed" || status === "skipped" ? status : "done";
}

/** How wide a mark above the track is, with room beside it. */
const MARK = 20;
/** A mark is moved at most so many places from its moment. */
const FARTHEST = 2 * MARK;

/** Where marks stand above a track (pixels), in the order of time: at their moments, but not over each other. */
export function markerPlaces(wanted: readonly number[]): number[] {
  let before = -Infinity;
  return wanted.map((at) => {
    before = Math.min(Math.max(at, before + MARK), at + FARTHEST);
    return before;
  });
}
