/** What of a map somebody wants to see, kept in this browser for each person; it changes nothing of what is checked. */
import type { SiteMap } from "@/api/types";

export const LAYERS = ["zones", "places", "check", "heat"] as const;
export type Layer = (typeof LAYERS)[number];

export type Chosen = Readonly<Record<Layer, boolean>> & {
  /** Whether the card is open; null before somebody has said so. */
  readonly open: boolean | null;
};

export const USUAL: Chosen = { zones: true, places: true, check: true, heat: false, open: null };

const placeOf = (person: string) => `vipo.layers.${person}`;

export function keepLayers(person: string, chosen: Chosen): void {
  localStorage.setItem(placeOf(person), JSON.stringify(chosen));
}

export function keptLayers(person: string): Chosen {
  return readLayers(localStorage.getItem(placeOf(person)));
}

/** What was kept, as far as it makes sense. */
export function readLayers(text: string | null): Chosen {
  try {
    const kept = JSON.parse(text ?? "{}") as Readonly<Record<string, unknown>> | null;
    const said = Object.entries(kept ?? {}).filter(([name, value]) => name in USUAL && typeof value === "boolean");
    return { ...USUAL, ...(Object.fromEntries(said) as Partial<Chosen>) };
  } catch {
    return USUAL;
  }
}

/** A map with what is shown of it; the place that was asked for is always there. */
export function shownMap(map: SiteMap, { zones, places }: Chosen, asked: string | null): SiteMap {
  if (zones && places) return map;
  return {
    ...map,
    zones: zones ? map.zones : [],
    places: places ? map.places : map.places.filter(({ id }) => id === asked),
  };
}
