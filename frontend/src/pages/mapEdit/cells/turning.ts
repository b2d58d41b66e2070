/** Turning a map about its middle: by right angles exact to a cell, by others to the nearest one. Pure. */
import type { CellMap } from "@/map/floor/rosFiles";
import { exact } from "./edits";

const MOST_SIDE = 4096;
const UNKNOWN = 255;

/** Turn by a right angle, anticlockwise or clockwise. */
export function turnQuarter(map: CellMap, way: "left" | "right"): CellMap {
  const { width, height, cells, resolution_m, origin } = map;
  const turned = new Uint8Array(cells.length);
  for (let row = 0; row < height; row += 1)
    for (let column = 0; column < width; column += 1) {
      const [toColumn, toRow] = way === "left" ? [height - 1 - row, column] : [row, width - 1 - column];
      turned[toRow * height + toColumn] = cells[row * width + column] ?? UNKNOWN;
    }
  const shift = ((width - height) / 2) * resolution_m;
  const corner = { x: exact(origin.x + shift), y: exact(origin.y - shift) };
  return { ...map, width: height, height: width, cells: turned, origin: corner };
}

/** Columns and rows of the map turned by so many degrees. */
function sidesTurned({ width, height }: CellMap, degrees: number): [width: number, height: number] {
  const angle = (degrees * Math.PI) / 180;
  const [cos, sin] = [Math.abs(Math.cos(angle)), Math.abs(Math.sin(angle))];
  const side = (along: number, across: number) => Math.ceil(Math.round((along * cos + across * sin) * 1e6) / 1e6);
  return [side(width, height), side(height, width)];
}

/** Whether the map turned by so many degrees has no more cells on a side than a map may have. */
export function fitsTurned(map: CellMap, degrees: number): boolean {
  return !(Math.max(...sidesTurned(map, degrees)) > MOST_SIDE);
}

/**
 * Turn by so many degrees anticlockwise; the map grows so that nothing is cut off, new corners are unknown.
 *
 * The same map where it does not fit turned.
 */
export function turnBy(map: CellMap, degrees: number): CellMap {
  if (!Number.isFinite(degrees) || Math.abs(degrees % 360) < 1e-9 || !fitsTurned(map, degrees)) return map;
  const angle = (degrees * Math.PI) / 180;
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  const [width, height] = sidesTurned(map, degrees);
  const cells = new Uint8Array(width * height).fill(UNKNOWN);
  for (let row = 0; row < height; row += 1)
    for (let column = 0; column < width; column += 1) {
      const [x, y] = [column + 0.5 - width / 2, row + 0.5 - height / 2];
      const [from, at] = [
        Math.floor(x * cos + y * sin + map.width / 2),
        Math.floor(y * cos - x * sin + map.height / 2),
      ];
      if (from >= 0 && at >= 0 && from < map.width && at < map.height)
        cells[row * width + column] = map.cells[at * map.width + from] ?? UNKNOWN;
    }
  const corner = {
    x: exact(map.origin.x + ((map.width - width) / 2) * map.resolution_m),
    y: exact(map.origin.y + ((map.height - height) / 2) * map.resolution_m),
  };
  return { ...map, width, height, cells, origin: corner };
}
