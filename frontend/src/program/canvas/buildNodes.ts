/** The scene as React Flow's nodes, with explicit sizes so that nothing is measured. */
import { activityWords } from "@/i18n/activity";
import { wallBoxes, type FloorPlan } from "@/map/floor/floor";
import { toPixels, type Box } from "@/map/plane/projection";
import { footprint, isRobot } from "@/map/devices/device";
import type { Chip } from "../scene/chips";
import { deviceBox, type SiteDevice } from "../surroundings";
import type { LevelOfDetail } from "../scene/detail";
import { boxAt, grown, legBoxes } from "../scene/geometry";
import { floorNames, labelPlace, labelWidth, type LabelPlace } from "../scene/labels";
import type { Scene } from "../scene/scene";
import { SpatialIndex } from "../scene/spatialIndex";
import type { Light } from "./MachineNode";
import type { MachineFlowNode, StageNode, StepFlowNode } from "./nodes";
import type { OtherPerson, StepState } from "./StepChip";

export interface NodeLooks {
  readonly selected: ReadonlySet<string>;
  readonly stateOf: (step: string) => StepState;
  readonly othersOn: ReadonlyMap<string, OtherPerson>;
  readonly lightOf: (device: SiteDevice) => Light;
  readonly captionOf: (device: SiteDevice) => string | null;
  readonly noteOf: (chip: Chip) => string | null;
  readonly labelOf: (chip: Chip) => string;
  readonly startLabel: string;
  readonly editable: boolean;
}

/** What has a node of its own among the constructs, and how much of it is shown. */
export interface Shown {
  readonly mounted: ReadonlySet<string>;
  readonly detail: LevelOfDetail;
}

/** No name stands farther from its machine than this and its own width, drawing pixels. */
const REACH = 60;
export const START_ID = ":start";
export const DEVICE_PREFIX = "device:";

/** Where each machine's name stands: over no chip, line, wall, machine or other name. */
export function placeLabels(
  scene: Scene,
  devices: readonly SiteDevice[],
  plan: FloorPlan | null = null,
): ReadonlyMap<string, LabelPlace> {
  const machines = devices.filter((device) => !isRobot(device));
  const drawn = new SpatialIndex([...drawnBoxes(scene), ...floorNames(plan?.places ?? [])].map((box) => ({ box })));
  const walls = plan && machines.length > 0 ? new SpatialIndex(wallBoxes(plan).map((box) => ({ box }))) : null;
  const names: Box[] = [];
  const labels = new Map<string, LabelPlace>();
  for (const device of machines) {
    const others = machines.filter((each) => each.id !== device.id).map((each) => grown(deviceBox(each), 4));
    const width = labelWidth(device.name, activityWords(device));
    const around = grown(deviceBox(device), width + REACH);
    const near = [...drawn.within(around), ...(walls?.within(around) ?? [])].map(({ box }) => box);
    const label = labelPlace(deviceBox(device), width, [...near, ...names, ...others]);
    names.push(label.box);
    labels.set(device.id, label);
  }
  return labels;
}

export function buildNodes(
  scene: Scene,
  devices: readonly SiteDevice[],
  labels: ReadonlyMap<string, LabelPlace>,
  looks: NodeLooks,
  { mounted, detail }: Shown,
): StageNode[] {
  return [
    ...devices.flatMap((device) => {
      const label = labels.get(device.id);
      return label ? [machineNode(device, label, looks, detail)] : [];
    }),
    startNode(scene, looks, detail),
    // In the order of the scene, which is the one in which they lie over each other and are reached by Tab.
    ...[...scene.chips.values()].filter(({ id }) => mounted.has(id)).map((chip) => stepNode(chip, looks, detail)),
  ];
}

/** The nodes of before wherever nothing of them has changed, so that React leaves them alone. */
export function keepUnchanged(before: readonly StageNode[], built: readonly StageNode[]): StageNode[] {
  const known = new Map(before.map((node) => [node.id, node]));
  return built.map((node) => {
    const old = known.get(node.id);
    return old &&
      isAlike({ ...old, data: 0, position: 0, measured: 0 }, { ...node, data: 0, position: 0, measured: 0 }) &&
      isAlike(old.data, node.data) &&
      isAlike(old.position, node.position)
      ? old
      : node;
  });
}

function isAlike(one: object, other: object): boolean {
  const [mine, theirs] = [Object.entries(one), other as Record<string, unknown>];
  return mine.length === Object.keys(theirs).length && mine.every(([key, value]) => isEqual(value, theirs[key]));
}

/** Origins are pairs of numbers, made anew each time. */
function isEqual(one: unknown, other: unknown): boolean {
  return one === other || (Array.isArray(one) && Array.isArray(other) && one.join() === other.join());
}

/** What names must not cover: chips, frames, lines, the edges of functions. */
function drawnBoxes(scene: Scene): Box[] {
  return [
    ...[...scene.chips.values()].map((chip) => grown(chip.box, 2)),
    ...scene.frames.map((frame) => frame.box),
    ...scene.routes.flatMap((route) => legBoxes(route.points, 4)),
    ...scene.hulls.flatMap((hull) => hull.outlines.flatMap((edge) => legBoxes([...edge, ...edge.slice(0, 1)], 2))),
    boxAt(scene.start, 78, 30),
  ];
}

function machineNode(device: SiteDevice, label: LabelPlace, looks: NodeLooks, detail: LevelOfDetail): MachineFlowNode {
  const size = footprint(device);
  const [width, height] = [Math.max(size.width, 52) + 8, Math.max(size.height, 52) + 8];
  return {
    id: DEVICE_PREFIX + device.id,
    type: "machine",
    position: toPixels([device.location.x, device.location.y]),
    origin: [0.5, 0.5],
    width,
    height,
    measured: { width, height },
    draggable: false,
    selectable: false,
    focusable: true,
    ariaLabel: `${device.name} ${activityWords(device)}`.trim(),
    zIndex: 1,
    data: {
      device,
      light: looks.lightOf(device),
      caption: looks.captionOf(device),
      side: label.side,
      gap: label.gap,
      detail,
    },
  };
}

function startNode(scene: Scene, looks: NodeLooks, detail: LevelOfDetail): StageNode {
  return {
    id: START_ID,
    type: "start",
    position: scene.start,
    origin: [0.5, 0.5],
    width: 78,
    height: 30,
    measured: { width: 78, height: 30 },
    draggable: looks.editable,
    selectable: false,
    focusable: false,
    zIndex: 2,
    data: { label: looks.startLabel, detail },
  };
}

function stepNode(chip: Chip, looks: NodeLooks, detail: LevelOfDetail): StepFlowNode {
  const selected = looks.selected.has(chip.id);
  return {
    id: chip.id,
    type: "step",
    position: chip.at,
    origin: [0.5, 0.5],
    width: chip.width,
    height: chip.height,
    measured: { width: chip.width, height: chip.height },
    draggable: looks.editable,
    selectable: true,
    selected,
    focusable: true,
    ariaLabel: looks.labelOf(chip),
    zIndex: selected ? 6 : 4,
    data: {
      chip,
      selected,
      state: looks.stateOf(chip.id),
      other: looks.othersOn.get(chip.id) ?? null,
      note: looks.noteOf(chip),
      joinable: looks.editable,
      detail,
    },
  };
}
