/** What stands at a point of the map: a step, an arrow, a machine or robot, or the bare floor. */
import { liveRobots } from "@/live/robots";
import { type Box, type Point, toMetres, toPixels } from "@/map/plane/projection";
import type { PixelPoint } from "@/map/plane/paths";
import { nearestOn } from "@/program/scene/geometry";
import type { Link } from "@/program/scene/links";
import type { Scene } from "@/program/scene/scene";
import { deviceBox, type SiteDevice } from "@/program/surroundings";
import { useScreen } from "./screen";

export interface Under {
  readonly step: string | null;
  readonly link: Link | null;
  readonly device: string | null;
  /** Metres. */
  readonly at: Point;
}

/** So near to an arrow a press means it, pixels of the screen. */
const NEAR_LINK = 9;
/** Metres around the middle of a robot. */
const ROBOT_M = 0.35;

/** What is under a point of the window; null where the map is not. */
export function underPointer(
  open: { readonly scene: Scene; readonly devices: readonly SiteDevice[] },
  at: { readonly x: number; readonly y: number },
): Under | null {
  const { stage } = useScreen.getState();
  if (!stage) return null;
  const reach = NEAR_LINK / stage.flow.getZoom();
  return { ...underPoint(open, stage.flow.screenToFlowPosition(at), reach, robotAt) };
}

/** A robot that drives is where its live pose is. */
export function robotAt(at: Point): string | null {
  const near = liveRobots(performance.now())
    .map((robot) => ({ id: robot.id, far: Math.hypot(robot.x - at[0], robot.y - at[1]) }))
    .filter(({ far }) => far <= ROBOT_M);
  return near.sort((one, other) => one.far - other.far)[0]?.id ?? null;
}

/** `point` and `reach` in drawing pixels. Steps lie over robots, robots over arrows and machines. */
export function underPoint(
  { scene, devices }: { readonly scene: Scene; readonly devices: readonly SiteDevice[] },
  point: PixelPoint,
  reach: number,
  robot: (at: Point) => string | null,
): Under {
  const at = toMetres(point);
  const nothing: Under = { step: null, link: null, device: null, at };
  const step = [...scene.chips.values()].findLast((chip) => isIn(chip.box, point))?.id;
  if (step !== undefined) return { ...nothing, step };
  const driving = robot(at);
  if (driving !== null) return { ...nothing, device: driving };
  const link = scene.links.find((each) => (nearestOn(each.points, point)?.off ?? Infinity) <= reach);
  if (link) return { ...nothing, link };
  const machine = devices.find((device) => device.kind !== "robot" && isIn(deviceBox(device), point));
  return { ...nothing, device: machine?.id ?? null };
}

function isIn(box: Box, { x, y }: PixelPoint): boolean {
  return x >= box.left && x <= box.right && y >= box.top && y <= box.bottom;
}

/** Where a point of the floor is on the screen, pixels of the window. */
export function onScreen(at: Point): { x: number; y: number } {
  return useScreen.getState().stage?.flow.flowToScreenPosition(toPixels(at)) ?? { x: 0, y: 0 };
}
