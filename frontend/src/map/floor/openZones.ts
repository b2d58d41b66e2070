/** Zones into which people let robots one by one, and that are open to all of them for a time. */
import { useEffect, useState } from "react";
import type { MapZone } from "./floor";

type Shutting = Pick<MapZone, "open_until">;
/** Timers of a browser that slept may be late, and take no pause of many days. */
const LONGEST_PAUSE_MS = 3_600_000;

/** Until when all robots drive in freely; null where they are let in one by one now. `now` is in milliseconds. */
export function openUntil({ open_until: until }: Shutting, now = Date.now()): string | null {
  return until && Date.parse(until) > now ? until : null;
}

/** The time at which zones are shown, milliseconds: another whenever one of them shuts. */
export function useZonesAt(zones: readonly Shutting[] | undefined): number {
  const [at, setAt] = useState(Date.now);
  useEffect(() => {
    const now = Date.now();
    // News of a zone that was opened and has shut since may come late, as after a time without a server.
    if ((zones ?? []).some((zone) => openUntil(zone, at) !== openUntil(zone, now))) setAt(now);
    const ends = (zones ?? []).flatMap((zone) => openUntil(zone, now) ?? []).map((until) => Date.parse(until) - now);
    if (ends.length === 0) return undefined;
    const timer = setTimeout(() => setAt(Date.now()), Math.min(LONGEST_PAUSE_MS, Math.min(...ends) + 1));
    return () => clearTimeout(timer);
  }, [zones, at]);
  return at;
}
