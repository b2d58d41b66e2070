/** The layers of a map as somebody looks at it: what is shown, and what there is to know about how it was used. */
import { useMediaQuery } from "@mantine/hooks";
import { useMemo, useState } from "react";
import { useFloorUse } from "@/api/floorUse";
import { useMe } from "@/api/queries";
import type { FloorUse, SiteMap } from "@/api/types";
import type { Underlay } from "@/map/floor/floorPainter";
import { type Heat, paintHeat } from "./heatPainter";
import { type Chosen, keepLayers, keptLayers, shownMap } from "./layers";

/** Where the map is small, the card hides it until somebody opens it. */
const ROOMY = "(width >= 1180px)";

export interface Layers {
  readonly chosen: Chosen;
  readonly change: (change: Partial<Chosen>) => void;
  readonly isOpen: boolean;
  /** The map with what is shown of it. */
  readonly plan: SiteMap;
  /** How the floor was used, and where most, where that is shown and known. */
  readonly use: FloorUse | undefined;
  readonly heat: Heat | null;
  /** Paints the heat on the floor. */
  readonly under: Underlay | null;
  readonly error: Error | null;
}

interface Looked {
  /** Off while somebody changes the map: then all of it is shown. */
  readonly on: boolean;
  /** The id of a place that was asked for. */
  readonly asked: string | null;
}

export function useLayers(slug: string, map: SiteMap, { on, asked }: Looked): Layers {
  const person = String(useMe().data?.user?.id ?? "");
  const [chosen, setChosen] = useState(() => keptLayers(person));
  const isRoomy = useMediaQuery(ROOMY, true, { getInitialValueInEffect: false });
  const hasHeat = on && chosen.heat;
  const { data, error } = useFloorUse(slug, { enabled: hasHeat });
  const use = hasHeat ? data : undefined;
  const heat = useMemo(() => (use ? { square_m: use.square_m, squares: use.heat } : null), [use]);
  return {
    chosen,
    change: (change) => {
      const next = { ...chosen, ...change };
      setChosen(next);
      keepLayers(person, next);
    },
    isOpen: chosen.open ?? isRoomy,
    plan: useMemo(() => (on ? shownMap(map, chosen, asked) : map), [on, map, chosen, asked]),
    use,
    heat,
    under: useMemo<Underlay | null>(
      () => heat && ((canvas, palette, floor) => paintHeat(canvas, palette, heat, floor)),
      [heat],
    ),
    error: hasHeat && !data ? error : null,
  };
}
