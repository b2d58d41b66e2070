/** The drawings of both sides and what is shown of them. */
import { useMemo } from "react";
import type { Comparison, Difference } from "@/api/types";
import type { FloorPlan } from "@/map/floor/floor";
import { useScene } from "@/program/canvas/useScene";
import { measureText } from "@/program/scene/textWidths";
import { type Compiled, EMPTY_DOCUMENT, type ProgramDocument } from "@/program/document/document";
import { wellFormed } from "@/program/document/wellFormed";
import type { Scene } from "@/program/scene/scene";
import type { SiteDevice, Surroundings } from "@/program/surroundings";
import type { Translate } from "@/program/words/stepWords";
import { drawnScene, type Ghost, ghostsOf, type Shown, type Tile, tilesOf } from "./marks";

interface Part {
  readonly document: ProgramDocument;
  readonly scene: Scene;
  readonly surroundings: Surroundings;
  readonly t: Translate;
  readonly compiled: Compiled | null;
}

export interface Pictures {
  readonly old: Part;
  readonly new: Part;
  readonly drawn: Scene;
  readonly ghosts: readonly Ghost[];
  readonly tiles: readonly Tile[];
  /** The side whose drawing is `drawn`. */
  readonly parts: Part;
}

export const NOTHING: Difference = { constructs: [], tidied: [], same: 0 };

function useSide(
  site: string,
  plan: FloorPlan | null,
  devices: readonly SiteDevice[],
  side: Comparison["old"] | undefined,
): Part {
  const compiled = (side?.compiled ?? null) as Compiled | null;
  const raw = side?.document;
  const document = useMemo(() => wellFormed(raw ?? EMPTY_DOCUMENT), [raw]);
  const { scene, surroundings, t } = useScene({
    site,
    plan,
    document,
    compiled,
    devices,
  });
  return useMemo(() => ({ document, scene, surroundings, t, compiled }), [document, scene, surroundings, t, compiled]);
}

/** Where one side cannot be read, the other is drawn alone. */
export function usePictures(
  site: string,
  plan: FloorPlan | null,
  devices: readonly SiteDevice[],
  comparison: Comparison | undefined,
  shown: Shown,
): Pictures {
  const old = useSide(site, plan, devices, comparison?.old);
  const next = useSide(site, plan, devices, comparison?.new);
  const difference = comparison?.difference ?? NOTHING;
  const side = comparison?.new.problem ? "old" : shown;
  return useMemo(() => {
    const drawn = drawnScene(side, old.scene, next.scene, difference, measureText);
    const ghosts = ghostsOf(side, old.scene, next.scene, difference);
    const tiles = tilesOf(drawn, ghosts, difference);
    return { old, new: next, drawn, ghosts, tiles, parts: side === "old" ? old : next };
  }, [old, next, difference, side]);
}
