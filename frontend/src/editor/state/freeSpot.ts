/** A free place for a chip that belongs to no place of its own. */
import { toMetres, toPixels, type Point } from "@/map/projection";
import { boxAt, grown, overlaps } from "../scene/geometry";
import { deviceBox } from "../scene/surroundings";
import type { OpenProgram } from "./context";
import { useUi } from "./ui";

/** Near the selected or the last step, covering neither chips nor machines. */
export function freeSpot({ scene, devices }: OpenProgram): Point {
  const last = useUi.getState().selected.at(-1) ?? scene.tree.reading.at(-1);
  const from = (last ? scene.chips.get(last)?.at : undefined) ?? scene.start;
  const taken = [
    ...[...scene.chips.values()].map((chip) => chip.box),
    ...devices.filter((device) => device.kind !== "robot").map(deviceBox),
  ];
  for (let ring = 1; ring < 12; ring += 1)
    for (const [dx, dy] of [
      [0, 1],
      [1, 0],
      [0, -1],
      [-1, 0],
    ] as const) {
      const at = { x: from.x + dx * ring * 70, y: from.y + dy * ring * 44 };
      if (!taken.some((box) => overlaps(box, grown(boxAt(at, 150, 30), 6)))) return toMetres(at);
    }
  return toMetres(from ?? toPixels([1, -1]));
}
