/** A function's body on the map: the hull around the places that it touches. */
import type { Box } from "@/map/projection";
import type { PixelPoint } from "@/map/routePath";
import type { ProgramDocument } from "../model/types";
import { withDescendants, type ProgramTree } from "../model/tree";
import type { Chip } from "./chips";
import { grown, legBoxes } from "./geometry";
import { outlinesAround } from "./outline";
import { endOf, startOf, type RouteShape } from "./routing";
import type { Surroundings } from "./surroundings";

export interface Hull {
  readonly functionId: string;
  /** Closed edges. */
  readonly outlines: readonly (readonly PixelPoint[])[];
}

export function hullsOf(
  document: ProgramDocument,
  tree: ProgramTree,
  chips: ReadonlyMap<string, Chip>,
  routes: ReadonlyMap<string, RouteShape>,
  surroundings: Surroundings,
  collapsed: ReadonlySet<string>,
): Hull[] {
  return Object.keys(document.functions)
    .filter((id) => !collapsed.has(id))
    .map((id) => {
      const inside = [...withDescendants(document, tree.children(id, "body"))];
      const boxes = inside.flatMap((step) => boxesOf(step, document, id, chips, routes, surroundings));
      return { functionId: id, outlines: outlinesAround(boxes) };
    })
    .filter((hull) => hull.outlines.length > 0);
}

function boxesOf(
  id: string,
  document: ProgramDocument,
  scope: string,
  chips: ReadonlyMap<string, Chip>,
  routes: ReadonlyMap<string, RouteShape>,
  surroundings: Surroundings,
): Box[] {
  const step = document.steps[id];
  if (!step) return [];
  const spots = [startOf(step, document, surroundings, scope), endOf(step, document, surroundings, scope)];
  const places = spots.flatMap((spot) => (spot?.box ? [{ ...grown(spot.box, 26), top: spot.box.top - 46 }] : []));
  const chip = chips.get(id);
  return [...places, ...(chip ? [grown(chip.box, 10)] : []), ...legBoxes(routes.get(id)?.points ?? [], 24)];
}
