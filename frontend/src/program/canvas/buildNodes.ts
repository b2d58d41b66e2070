/** The scene as React Flow's nodes, with explicit sizes so that nothing is measured. */
import { activityWords } from "@/i18n/activity";
import { wallBoxes, type FloorPlan } from "@/map/floor/floor";
import { toPixels, type Box } from "@/map/plane/projection";
import { footprint, isRobot } from "@/map/devices/device";
import type { Chip } from "../scene/chips";
import { deviceBox, type SiteDevice } from "../surroundings";
import { boxAt, grown, legBoxes, overlaps } from "../scene/geometry";
import { floorNames, labelPlace, labelWidth, type LabelPlace } from "../scene/labels";
import type { Scene } from "../scene/scene";
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

/** No name stands farther from its machine than this and its own width, drawing pixels. */
const REACH = 60;
export const START_ID = ":start";
export const DEVICE_PREFIX = "device:";

export function buildNodes(
  scene: Scene,
  devices: readonly SiteDevice[],
  looks: NodeLooks,
  plan: FloorPlan | null = null,
): StageNode[] {
  const chips = [...scene.chips.values()];
  const machines = devices.filter((device) => !isRobot(device));
  const covers = [...drawnBoxes(scene), ...floorNames(plan?.places ?? [])];
  const walls = plan ? wallBoxes(plan) : [];
  return [
    ...machines.map((device) => {
      const others = machines.filter((each) => each.id !== device.id).map((each) => grown(deviceBox(each), 4));
      const box = deviceBox(device);
      const width = labelWidth(device.name, activityWords(device));
      const near = walls.filter((wall) => overlaps(grown(box, width + REACH), wall));
      const label = labelPlace(box, width, [...covers, ...others, ...near]);
      covers.push(label.box);
      return machineNode(device, label, looks);
    }),
    startNode(scene, looks),
    ...chips.map((chip) => stepNode(chip, looks)),
  ];
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

function machineNode(device: SiteDevice, label: LabelPlace, looks: NodeLooks): MachineFlowNode {
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
    },
  };
}

function startNode(scene: Scene, looks: NodeLooks): StageNode {
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
    data: { label: looks.startLabel },
  };
}

function stepNode(chip: Chip, looks: NodeLooks): StepFlowNode {
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
    },
  };
}
