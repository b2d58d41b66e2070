/** The floor of a place as a picture: the cells that are known, a metre grid, the rooms' names. */
import type { Palette } from "./palette";
import { type Prism, shadowOf } from "./shadows";
import type { SceneMap } from "./types";

const PIXELS_PER_METRE = 40;
/** No side of the floor's picture is longer: tablets take no larger ones, and a hall of 200 m would need 256 MB. */
const MOST_PIXELS = 4096;
const UNKNOWN = 255;

/** Pixels for a metre of floor, fewer on a large one. */
export function pixelsPerMetre(map: Pick<SceneMap, "width" | "height" | "resolution_m">): number {
  return Math.min(PIXELS_PER_METRE, MOST_PIXELS / (Math.max(map.width, map.height) * map.resolution_m));
}

/** The cells that are known, one pixel for each. */
function cellsPicture(map: SceneMap, palette: Palette): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = map.width;
  canvas.height = map.height;
  const context = canvas.getContext("2d");
  if (!context) return canvas;
  context.fillStyle = palette.floor;
  context.fillRect(0, 0, map.width, map.height);
  const picture = context.getImageData(0, 0, map.width, map.height);
  for (let row = 0; row < map.height; row += 1)
    for (let column = 0; column < map.width; column += 1)
      if (map.cells[row * map.width + column] === UNKNOWN)
        picture.data[((map.height - 1 - row) * map.width + column) * 4 + 3] = 0;
  context.putImageData(picture, 0, 0);
  return canvas;
}

function drawCells(context: CanvasRenderingContext2D, map: SceneMap, palette: Palette) {
  context.imageSmoothingEnabled = false;
  context.drawImage(cellsPicture(map, palette), 0, 0, context.canvas.width, context.canvas.height);
}

function drawGridAndNames(context: CanvasRenderingContext2D, map: SceneMap, palette: Palette) {
  const { width, height } = context.canvas;
  const perMetre = pixelsPerMetre(map);
  context.globalCompositeOperation = "source-atop";
  context.strokeStyle = palette.grid;
  context.lineWidth = 1;
  for (let x = Math.ceil(map.origin.x); (x - map.origin.x) * perMetre < width; x += 1) {
    const at = (x - map.origin.x) * perMetre;
    context.strokeRect(at, -1, 0, height + 2);
  }
  for (let y = Math.ceil(map.origin.y); (y - map.origin.y) * perMetre < height; y += 1) {
    const at = height - (y - map.origin.y) * perMetre;
    context.strokeRect(-1, at, width + 2, 0);
  }
  context.fillStyle = palette.text;
  context.font = `600 ${0.42 * perMetre}px Inter Variable, sans-serif`;
  context.letterSpacing = "3px";
  for (const place of map.places.filter((p) => p.kind === "room")) {
    const [labelX, labelY] = place.label ?? [place.x, place.y];
    const x = (labelX - map.origin.x) * perMetre;
    context.textAlign = x > width * 0.85 ? "right" : "left";
    context.fillText(place.name.toUpperCase(), x, height - (labelY - map.origin.y) * perMetre);
  }
}

/** All shadows as one shape, so that where they lie over each other it is no darker. */
function drawShadows(context: CanvasRenderingContext2D, map: SceneMap, palette: Palette, prisms: readonly Prism[]) {
  const perMetre = pixelsPerMetre(map);
  context.globalCompositeOperation = "source-atop";
  context.beginPath();
  for (const prism of prisms) {
    for (const [index, [x, y]] of shadowOf(prism).entries()) {
      const at = [(x - map.origin.x) * perMetre, context.canvas.height - (y - map.origin.y) * perMetre] as const;
      if (index === 0) context.moveTo(...at);
      else context.lineTo(...at);
    }
    context.closePath();
  }
  context.fillStyle = palette.dark ? "rgb(0 0 0 / 0.38)" : "rgb(23 27 38 / 0.2)";
  context.fill();
}

/** Draw the floor over the whole of a canvas, with the shadows of what stands on it. */
export function drawFloor(
  context: CanvasRenderingContext2D,
  map: SceneMap,
  palette: Palette,
  prisms: readonly Prism[],
): void {
  drawCells(context, map, palette);
  drawGridAndNames(context, map, palette);
  drawShadows(context, map, palette, prisms);
}
