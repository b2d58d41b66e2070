/** Where two maps of the same floor differ, as outlines for drawing. Pure. */
import { cellAt, cellBoxToPixels, knownBox, mergeCells, type FloorPlan } from "./floor";
import type { Box } from "../plane/projection";

/** Outlines (SVG path data in drawing pixels) of what the second map has more or less than the first. */
export interface DifferencePaths {
  wallsGained: string;
  wallsLost: string;
  floorGained: string;
  floorLost: string;
}

const [FREE, WALL] = [0, 100];

export function differencePaths(before: FloorPlan, after: FloorPlan): DifferencePaths {
  return {
    wallsGained: outline(after, before, WALL),
    wallsLost: outline(before, after, WALL),
    floorGained: outline(after, before, FREE),
    floorLost: outline(before, after, FREE),
  };
}

/** The cells of `plan` that are of a kind, where `other` is not of that kind. */
function outline(plan: FloorPlan, other: FloorPlan, kind: number): string {
  const cells = new Uint8Array(plan.cells.length);
  const side = plan.resolution_m;
  for (let row = 0, index = 0; row < plan.height; row += 1) {
    const y = plan.origin.y + (row + 0.5) * side;
    for (let column = 0; column < plan.width; column += 1, index += 1) {
      if (plan.cells[index] !== kind) continue;
      if (cellAt(other, [plan.origin.x + (column + 0.5) * side, y]) !== kind) cells[index] = 1;
    }
  }
  const marked = { ...plan, cells };
  return mergeCells(marked, (cell) => cell === 1)
    .map((box) => pathOf(cellBoxToPixels(marked, box)))
    .join("");
}

function pathOf(box: Box): string {
  const [left, top, right, bottom] = [box.left, box.top, box.right, box.bottom].map((value) => value.toFixed(2));
  return `M${left} ${top}H${right}V${bottom}H${left}Z`;
}

/** The part of the drawing plane that shows what either map knows. */
export function sharedBox(one: FloorPlan, other: FloorPlan): Box {
  const [a, b] = [knownBox(one), knownBox(other)];
  return {
    left: Math.min(a.left, b.left),
    top: Math.min(a.top, b.top),
    right: Math.max(a.right, b.right),
    bottom: Math.max(a.bottom, b.bottom),
  };
}
