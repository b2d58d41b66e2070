/** A line through readings over a window of time that ends now. Pure. */
interface Numbered {
  readonly at: number;
  readonly value: number;
}

interface Frame {
  readonly now: number;
  readonly window_ms: number;
  readonly width: number;
  readonly height: number;
}

interface Kept extends Numbered {
  readonly minimum: number;
  readonly maximum: number;
}

/** The corners of what was kept: within its span a reading reached its least and greatest, after it nothing changed. */
export function cornersOf(points: readonly Kept[], span_ms: number): Numbered[] {
  return points.flatMap(({ at, value, minimum, maximum }, index) => {
    const before = points[index - 1];
    const held = before && at - before.at > 2 * span_ms ? [{ at: at - span_ms, value: before.value }] : [];
    const reached = [minimum, maximum].filter((each) => each !== value).map((each) => ({ at, value: each }));
    return [...held, ...reached, { at, value }];
  });
}

/** What was kept, and behind it what has come live since: the live ones are exact. */
export function joinReadings(kept: readonly Numbered[], live: readonly Numbered[]): Numbered[] {
  const first = live[0]?.at ?? Infinity;
  return [...kept.filter((each) => each.at < first), ...live];
}

/** The readings of a window; what held before it counts as its left edge. */
function seenIn(readings: readonly Numbered[], from: number): Numbered[] {
  const before = readings.filter((each) => each.at < from).at(-1);
  return [...(before ? [{ at: from, value: before.value }] : []), ...readings.filter((each) => each.at >= from)];
}

/** The least and the greatest reading of the window; there has to be one. */
export function rangeOf(readings: readonly Numbered[], { now, window_ms }: Frame): { low: number; high: number } {
  const values = seenIn(readings, now - window_ms).map((each) => each.value);
  return { low: Math.min(...values), high: Math.max(...values) };
}

/** SVG paths of the line and of the area below it; null without readings. A steady value lies in the lower third. */
export function sparkPath(readings: readonly Numbered[], frame: Frame) {
  const from = frame.now - frame.window_ms;
  const seen = seenIn(readings, from);
  const last = seen.at(-1);
  if (!last) return null;
  const values = seen.map((each) => each.value);
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const x = (at: number) => round(((at - from) / frame.window_ms) * frame.width);
  const y = (value: number) => round(frame.height * (high > low ? 0.9 - (0.8 * (value - low)) / (high - low) : 0.7));
  const end = [round(frame.width), y(last.value)] as const;
  const corners = [...seen.map((each) => [x(each.at), y(each.value)] as const), end];
  const line = corners.map(([across, down], index) => `${index === 0 ? "M" : "L"}${across} ${down}`).join("");
  const start = corners[0]?.[0] ?? 0;
  return { line, area: `${line}V${frame.height}H${start}Z`, end };
}

function round(value: number): number {
  return Math.round(value * 10) / 10;
}
