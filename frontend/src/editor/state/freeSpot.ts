/** A free place for a chip that belongs to no place of its own. */
import { type FloorPlan, knownBox } from "@/map/floor/floor";
import { toMetres, toPixels, type Box, type Point } from "@/map/plane/projection";
import type { PixelPoint } from "@/map/plane/paths";
import { boxAt, centre, grown, legBoxes, overlaps } from "@/program/scene/geometry";
import { isFramed, kindOf } from "@/program/kinds";
import { outerBox, type Scene } from "@/program/scene/scene";
import { deviceBox } from "@/program/surroundings";
import type { OpenProgram } from "./context";
import { useUi } from "./ui";

interface Size {
  readonly width: number;
  readonly height: number;
}

const CHIP = { width: 150, height: 30 };
/** Room for a frame's first step, too. */
const FRAME = { width: 190, height: 110 };
/** Room for both branches, which leave it above and below, and what they say. */
const DIAMOND = { width: 200, height: 176 };
/** What a machine is called stands below it. */
const LABEL = 34;
const WAYS = [
  [0, 1],
  [1, 0],
  [-1, 0],
  [0, -1],
  [1, 1],
  [-1, 1],
  [1, -1],
  [-1, -1],
] as const;

/** On the floor near a point, else near the selected or the last step, covering neither chips, frames nor machines. */
export function freeSpot(open: OpenProgram, kind = "", near?: Point): Point {
  const { scene, devices, plan } = open;
  const last = useUi.getState().selected.at(-1) ?? scene.tree.reading.at(-1);
  const from = near ? toPixels(near) : ((last ? scene.chips.get(last)?.at : undefined) ?? scene.start);
  const taken = [
    ...[...scene.chips.values()].map((chip) => outerBox(scene, chip.id) ?? chip.box),
    ...devices.filter((device) => device.kind !== "robot").map((device) => labelled(deviceBox(device))),
    boxAt(scene.start, 90, 40),
    ...openEnds(scene),
  ];
  return toMetres(freeOn(plan, from, sizeOf(kind), taken));
}

/** On the floor near a point, from its middle where that is far off; beside the floor where it is full or too small. */
export function freeOn(plan: FloorPlan | null, from: PixelPoint, size: Size, taken: readonly Box[]): PixelPoint {
  const floor = plan && knownBox(plan);
  const near = freeNear(from, size, taken, floor);
  if (near) return near;
  const start = floor && !overlaps(floor, boxAt(from, 0, 0)) ? centre(floor) : from;
  return freeNear(start, size, taken, floor) ?? freeNear(start, size, taken, null) ?? start;
}

function labelled(machine: Box): Box {
  return { ...machine, bottom: machine.bottom + LABEL };
}

function sizeOf(kind: string): Size {
  if (isFramed(kind)) return FRAME;
  return kindOf(kind).shape === "diamond" ? DIAMOND : CHIP;
}

/** Around the ends of branches without a step: what stands there would look like their step. */
export function openEnds({ links }: Pick<Scene, "links">): Box[] {
  return links.filter((link) => link.to === null).flatMap((link) => legBoxes(link.points, 12));
}

/** The nearest point of widening rings where the box is inside the floor and covers nothing. */
export function freeNear(from: PixelPoint, size: Size, taken: readonly Box[], floor: Box | null): PixelPoint | null {
  for (let ring = 1; ring < 14; ring += 1)
    for (const [dx, dy] of WAYS) {
      const at = { x: from.x + dx * ring * 70, y: from.y + dy * ring * 46 };
      const box = grown(boxAt(at, size.width, size.height), 6);
      if ((!floor || inside(box, floor)) && !taken.some((each) => overlaps(each, box))) return at;
    }
  return null;
}

function inside(box: Box, floor: Box): boolean {
  return box.left > floor.left && box.right < floor.right && box.top > floor.top && box.bottom < floor.bottom;
}
