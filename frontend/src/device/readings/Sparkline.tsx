/** A property's readings over a range as a small line: what the server kept, and what has come live since. */
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Series } from "@/api/types";
import { formatReading } from "@/i18n/format";
import { readingsOf, type Reading } from "@/live/readings";
import { cornersOf, joinReadings, rangeOf, sparkPath } from "./spark";
import { RANGE_MS, useHistory, type Range } from "./useHistory";
import styles from "./readings.module.css";

const WIDTH = 104;
const HEIGHT = 30;
const LIVE_MS = 500;
const SLOW_MS = 5000;

interface SparklineProps {
  slug: string;
  device: string;
  property: string;
  range: Range;
  colour: string;
}

/** Milliseconds since the page was opened, kept current while the line is on the screen. */
function useClock(every_ms: number): number {
  const [now, setNow] = useState(() => performance.now());
  useEffect(() => {
    const timer = setInterval(() => setNow(performance.now()), every_ms);
    return () => clearInterval(timer);
  }, [every_ms]);
  return now;
}

/** The server's points with times as performance.now() has them. */
function numbered(series: Series | undefined, range: Range) {
  const offset = performance.timeOrigin;
  const points = (series?.points ?? []).flatMap(({ at, value, minimum, maximum }) =>
    typeof value === "number"
      ? [{ at: Date.parse(at) - offset, value, minimum: minimum ?? value, maximum: maximum ?? value }]
      : [],
  );
  // The last minutes are short: what was reached within each would stand in it as a spike.
  return range === "now" ? points : cornersOf(points, (series?.bucket_s ?? 0) * 1000);
}

export function Sparkline({ slug, device, property, range, colour }: SparklineProps) {
  const { t } = useTranslation();
  const now = useClock(range === "now" ? LIVE_MS : SLOW_MS);
  const series = useHistory(slug, device, property, range).data;
  const live = readingsOf(device, property).filter(
    (each): each is Reading & { value: number } => typeof each.value === "number",
  );
  const readings = joinReadings(numbered(series, range), live);
  const frame = { now, window_ms: RANGE_MS[range], width: WIDTH, height: HEIGHT };
  const path = sparkPath(readings, frame);
  if (!path) return null;
  const { low, high } = rangeOf(readings, frame);
  const words = { low: formatReading(low), high: formatReading(high) };
  return (
    <figure className={styles.spark}>
      <svg width={WIDTH} height={HEIGHT + 4} viewBox={`0 -2 ${WIDTH + 3} ${HEIGHT + 4}`} aria-hidden="true">
        <path d={path.area} fill={colour} opacity={0.12} />
        <path d={path.line} fill="none" stroke={colour} strokeWidth={1.6} strokeLinejoin="round" />
        <circle cx={path.end[0]} cy={path.end[1]} r={2.6} fill={colour} />
      </svg>
      <figcaption>{low === high ? t("device.history.steady") : t("device.history.range", words)}</figcaption>
    </figure>
  );
}
