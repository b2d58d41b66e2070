/** Where a machine's name stands so that it covers nothing. */
import type { Box } from "@/map/plane/projection";
import type { MapPlace } from "@/map/floor/floor";
import { toPixels } from "@/map/plane/projection";
import { boxAt, leastCovering } from "./geometry";

export interface LabelPlace {
  readonly side: "below" | "above" | "right" | "left";
  /** Further away than usual, drawing pixels: beyond a chip that is docked at that side. */
  readonly gap: number;
  readonly box: Box;
}

const HEIGHT = 30;
const BEYOND_A_CHIP = 19;

/** Below, above, beyond a docked chip, or beside the machine: the first that is free. */
export function labelPlace(machine: Box, width: number, covers: readonly Box[]): LabelPlace {
  const [x, y] = [(machine.left + machine.right) / 2, (machine.top + machine.bottom) / 2];
  const half = Math.max(machine.bottom - machine.top, 52) / 2;
  const vertical = (side: "below" | "above", gap: number): LabelPlace => ({
    side,
    gap,
    box: boxAt({ x, y: y + (side === "below" ? 1 : -1) * (half + 3 + gap + HEIGHT / 2) }, width, HEIGHT),
  });
  const beside = Math.max(machine.right - machine.left, 52) / 2 + 8 + width / 2;
  return leastCovering(
    [
      vertical("below", 0),
      vertical("above", 0),
      vertical("below", BEYOND_A_CHIP),
      vertical("above", BEYOND_A_CHIP),
      { side: "right", gap: 0, box: boxAt({ x: x + beside, y }, width, HEIGHT) },
      { side: "left", gap: 0, box: boxAt({ x: x - beside, y }, width, HEIGHT) },
    ],
    covers,
  );
}

/** About as wide as two lines of a label are written. */
export function labelWidth(name: string, doing: string): number {
  return Math.max(name.length * 6.7, doing.length * 6) + 4;
}

/** The names of rooms and docks that are written on the floor. */
export function floorNames(places: readonly MapPlace[]): Box[] {
  return places.flatMap((place) => {
    const { x, y } = toPixels(place.kind === "room" && place.label ? place.label : [place.x, place.y]);
    const width = place.name.length * 6.2;
    if (place.kind === "room") return [{ left: x - 2, right: x + width, top: y - 10, bottom: y + 4 }];
    return place.kind === "dock" ? [boxAt({ x, y: y - 10 }, Math.max(40, width), 78)] : [];
  });
}
