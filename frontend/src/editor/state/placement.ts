/** Where a fresh chip goes so that it covers nothing. */
import { toMetres, type Box, type Point } from "@/map/plane/projection";
import { pointAlong, pathLength, stretches, towards, type PixelPoint } from "@/map/plane/paths";
import { boxAt, grown, overlaps } from "@/program/scene/geometry";

const CHIP = { width: 116, height: 30 };
const PARTS = [0.5, 0.35, 0.65, 0.2, 0.8];

/** On the longest straight stretch of a route that has no other chip. */
export function spotOnRoute(points: readonly PixelPoint[], taken: readonly Box[]): Point {
  for (const leg of stretches(points)) {
    for (const part of PARTS) {
      const at = towards(leg.a, leg.b, leg.length * part);
      const box = grown(boxAt(at, CHIP.width, CHIP.height), 4);
      if (leg.length > 30 && !taken.some((each) => overlaps(each, box))) return toMetres(at);
    }
  }
  return toMetres(pointAlong(points, pathLength(points) / 2) ?? { x: 0, y: 0 });
}

/** On a machine's outline: its top, or the next side that is free. */
export function spotOnMachine(machine: Box, taken: readonly Box[]): Point {
  const [x, y] = [(machine.left + machine.right) / 2, (machine.top + machine.bottom) / 2];
  const sides = [
    { x, y: machine.top },
    { x, y: machine.bottom },
    { x: machine.right + 40, y },
    { x: machine.left - 40, y },
    { x, y: machine.top - 34 },
    { x, y: machine.bottom + 34 },
  ];
  const free = sides.find((side) => {
    const box = boxAt(side, CHIP.width, CHIP.height);
    return !taken.some((each) => overlaps(each, box));
  });
  return toMetres(free ?? { x, y: machine.bottom + 68 });
}

/** Above a robot, clear of it and of what is taken: it stands on nothing that could be pressed. */
export function spotByRobot(robot: Box, taken: readonly Box[]): Point {
  const x = (robot.left + robot.right) / 2;
  const heights = [40, 74, 108].map((gap) => robot.top - gap);
  const free = heights.find((y) => !taken.some((each) => overlaps(each, boxAt({ x, y }, CHIP.width, CHIP.height))));
  return toMetres({ x, y: free ?? robot.top - 142 });
}

/** Under the last step of a frame, so that a new one stands inside it. */
export function spotBelow(box: Box): Point {
  return toMetres({ x: (box.left + box.right) / 2, y: box.bottom + 20 });
}
