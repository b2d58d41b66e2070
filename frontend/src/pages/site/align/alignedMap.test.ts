import { expect, test } from "vitest";
import type { CellMap } from "@/map/floor/rosFiles";
import { alignedMap } from "./alignedMap";

const SAME = { scale: 1, theta: 0, shift: [0, 0] } as const;

function mapOf(rows: readonly string[], resolution_m = 1, origin = { x: 0, y: 0 }): CellMap {
  const cells = new Uint8Array([...rows].reverse().flatMap((row) => [...row].map(cellOf)));
  return { width: rows[0]?.length ?? 0, height: rows.length, resolution_m, origin, cells };
}

const cellOf = (letter: string) => (letter === "#" ? 100 : letter === "." ? 0 : 255);

function rowsOf({ width, height, cells }: CellMap): string[] {
  const letters = [...cells].map((cell) => (cell === 100 ? "#" : cell === 0 ? "." : "?"));
  return Array.from({ length: height }, (_, row) => letters.slice(row * width, (row + 1) * width).join("")).reverse();
}

test("a map that lies where it belongs stays exactly as it is", () => {
  const map = mapOf(["##.", "#..", "?.#"], 0.05, { x: -1.35, y: 2.45 });
  const aligned = alignedMap(map, SAME, map);
  expect(aligned && rowsOf(aligned)).toEqual(rowsOf(map));
  expect(aligned?.origin).toEqual(map.origin);
});

test("a quarter turn is exact, and the frame is that of the present map", () => {
  const map = mapOf(["##.", "#.."]);
  const turned = alignedMap(map, { scale: 1, theta: Math.PI / 2, shift: [2, 0] }, map);
  expect(turned && rowsOf(turned)).toEqual(["..", "#.", "##"]);
  expect(turned?.origin).toEqual({ x: 0, y: 0 });
});

test("a thin wall stays whole in larger cells", () => {
  const map = mapOf(["......", "######", "......", "......", "......", "......"], 0.02);
  const aligned = alignedMap(map, SAME, { resolution_m: 0.05, origin: { x: 0, y: 0 } });
  expect(aligned && rowsOf(aligned)[1]).toBe("###");
});

test("cells lie on the lattice of the present map", () => {
  const shifted = alignedMap(
    mapOf(["#."]),
    { ...SAME, shift: [0.3, 0.2] },
    { resolution_m: 1, origin: { x: 0.5, y: 0 } },
  );
  expect(shifted?.origin).toEqual({ x: -0.5, y: 0 });
  expect(shifted && [shifted.width, shifted.height]).toEqual([3, 2]);
});

test("a map that would have too many cells is none", () => {
  expect(alignedMap(mapOf(["#."]), { ...SAME, scale: 5000 }, mapOf(["."]))).toBeNull();
});
