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

/** SVG paths of the line and of the area below it; null without readings. A steady value lies in the lower third. */
export function sparkPath(readings: readonly Numbered[], frame: Frame) {
  const from = frame.now - frame.window_ms;
  const before = readings.filter((each) => each.at < from).at(-1);
  const seen = [...(before ? [{ at: from, value: before.value }] : []), ...readings.filter((each) => each.at >= from)];
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
