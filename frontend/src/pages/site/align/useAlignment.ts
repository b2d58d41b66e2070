/** Three points of a brought map and where they are on the present one, and the map that follows from them. */
import { useDeferredValue, useMemo, useState } from "react";
import type { CellMap } from "@/map/floor/rosFiles";
import type { Pixel } from "../plan/picture";
import { alignedMap } from "./alignedMap";
import { fit, residuals, type Point, type Similarity } from "./similarity";

export type Side = "from" | "to";
type Points = Readonly<Record<Side, readonly Pixel[]>>;

export interface Alignment {
  readonly points: Points;
  readonly put: (side: Side, index: number, at: Pixel) => void;
  readonly keepScale: boolean;
  readonly setKeepScale: (keep: boolean) => void;
  readonly found: { by: Similarity; each: readonly number[]; all: number } | null;
  /** The brought map where it belongs; null while the points say nothing, or it had too many cells. */
  readonly map: CellMap | null;
}

/** Where the points stand at first: three corners of a map, a little inside. */
function firstPoints({ width, height }: CellMap): readonly Pixel[] {
  const at = (x: number, y: number): Pixel => [Math.round(width * x), Math.round(height * y)];
  return [at(0.15, 0.2), at(0.85, 0.2), at(0.15, 0.8)];
}

/** A point of a map's picture in metres of its frame. */
export function metresOf({ height, resolution_m: side, origin }: CellMap, [x, y]: Pixel): Point {
  return [origin.x + x * side, origin.y + (height - y) * side];
}

export function useAlignment(brought: CellMap | null, present: CellMap, fixedScale: boolean): Alignment {
  const [kept, keep] = useState<{ of: CellMap; from: readonly Pixel[] } | null>(null);
  const [to, setTo] = useState(() => firstPoints(present));
  const [keepScale, setKeepScale] = useState<boolean | null>(null);
  const isKept = keepScale ?? fixedScale;
  const isSame = kept !== null && kept.of.width === brought?.width && kept.of.height === brought.height;
  const from = useMemo(() => (isSame ? kept.from : brought ? firstPoints(brought) : []), [isSame, kept, brought]);
  const found = useMemo(() => {
    if (!brought) return null;
    const [a, b] = [from.map((at) => metresOf(brought, at)), to.map((at) => metresOf(present, at))];
    const by = fit(a, b, isKept);
    return by && { by, ...residuals(by, a, b) };
  }, [brought, present, from, to, isKept]);
  const settled = useDeferredValue(found);
  const map = useMemo(
    () => (brought && settled ? alignedMap(brought, settled.by, present) : null),
    [brought, settled, present],
  );
  const replaced = (points: readonly Pixel[], index: number, at: Pixel) =>
    points.map((known, each) => (each === index ? at : known));
  return {
    points: { from, to },
    put: (side, index, at) => {
      if (side === "to") setTo(replaced(to, index, at));
      else if (brought) keep({ of: brought, from: replaced(from, index, at) });
    },
    keepScale: isKept,
    setKeepScale,
    found,
    map,
  };
}
