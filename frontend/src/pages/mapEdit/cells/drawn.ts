/** Maps out of letters for tests: `#` wall, `.` floor, `?` unknown; the first line is the top row. */
import type { CellMap } from "@/map/floor/rosFiles";

const CELLS: Readonly<Record<string, number>> = { "#": 100, ".": 0, "?": 255 };

export function drawn(...lines: string[]): CellMap {
  const rows = [...lines].reverse();
  const cells = Uint8Array.from(rows.flatMap((row) => [...row].map((letter) => CELLS[letter] ?? 255)));
  return { width: lines[0]?.length ?? 0, height: lines.length, resolution_m: 1, origin: { x: 0, y: 0 }, cells };
}

export function letters({ width, height, cells }: CellMap): string[] {
  const word = (row: number) =>
    [...cells.subarray(row * width, (row + 1) * width)].map((cell) => ({ 0: ".", 100: "#" })[cell] ?? "?").join("");
  return Array.from({ length: height }, (_, row) => word(height - 1 - row));
}
