/** A property's readings of this session as a small line; draws itself, twice a second. */
import { useEffect, useState } from "react";
import { readingsOf, type Reading } from "@/live/readings";
import { sparkPath } from "./spark";

const WIDTH = 104;
const HEIGHT = 30;
const WINDOW_MS = 120_000;

export function Sparkline({ device, property, colour }: { device: string; property: string; colour: string }) {
  const [now, setNow] = useState(() => performance.now());
  useEffect(() => {
    const timer = setInterval(() => setNow(performance.now()), 500);
    return () => clearInterval(timer);
  }, []);
  const readings = readingsOf(device, property).filter(
    (each): each is Reading & { value: number } => typeof each.value === "number",
  );
  const path = sparkPath(readings, { now, window_ms: WINDOW_MS, width: WIDTH, height: HEIGHT });
  if (!path) return null;
  return (
    <svg width={WIDTH} height={HEIGHT + 4} viewBox={`0 -2 ${WIDTH + 3} ${HEIGHT + 4}`} aria-hidden="true">
      <path d={path.area} fill={colour} opacity={0.12} />
      <path d={path.line} fill="none" stroke={colour} strokeWidth={1.6} strokeLinejoin="round" />
      <circle cx={path.end[0]} cy={path.end[1]} r={2.6} fill={colour} />
    </svg>
  );
}
