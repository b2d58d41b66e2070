/** A map as the two files of ROS's map_server, exact to a cell. Pure but for the files that it makes. */
export interface CellMap {
  readonly width: number;
  readonly height: number;
  readonly resolution_m: number;
  readonly origin: { readonly x: number; readonly y: number };
  /** Row by row from the bottom row: 0 free, 100 wall, 255 unknown. */
  readonly cells: Uint8Array;
}

const SHADES: Readonly<Record<number, number>> = { 0: 254, 100: 0 };
const UNKNOWN_SHADE = 205;

/** The image: P5, top row first. */
export function writePgm({ width, height, cells }: CellMap): Uint8Array<ArrayBuffer> {
  const head = new TextEncoder().encode(`P5\n${String(width)} ${String(height)}\n255\n`);
  const file = new Uint8Array(head.length + width * height).fill(UNKNOWN_SHADE);
  file.set(head);
  for (let row = 0; row < height; row += 1) {
    const from = (height - 1 - row) * width;
    for (let column = 0; column < width; column += 1)
      file[head.length + row * width + column] = SHADES[cells[from + column] ?? 255] ?? UNKNOWN_SHADE;
  }
  return file;
}

/** The header that belongs to the image of that name. */
export function writeYaml({ resolution_m, origin }: CellMap, image: string): string {
  return [
    `image: ${image}`,
    "mode: trinary",
    `resolution: ${String(resolution_m)}`,
    `origin: [${String(origin.x)}, ${String(origin.y)}, 0]`,
    "negate: 0",
    "occupied_thresh: 0.65",
    "free_thresh: 0.196",
    "",
  ].join("\n");
}

/** Both as the fields of a form that the server takes. */
export function rosForm(map: CellMap): FormData {
  const form = new FormData();
  form.set("yaml", new File([writeYaml(map, "map.pgm")], "map.yaml"));
  form.set("image", new File([writePgm(map)], "map.pgm"));
  return form;
}
