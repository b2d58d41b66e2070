/** Commands that put selected steps in line on the map; each is one ordinary edit. */
import {
  AlignCenterHorizontal,
  AlignCenterVertical,
  AlignEndHorizontal,
  AlignEndVertical,
  AlignHorizontalDistributeCenter,
  AlignStartHorizontal,
  AlignStartVertical,
  AlignVerticalDistributeCenter,
  LayoutGrid,
} from "lucide-react";
import type { Box } from "@/map/plane/projection";
import { outermost } from "@/program/document/tree";
import { centre, grown, overlaps } from "@/program/scene/geometry";
import { outerBox } from "@/program/scene/scene";
import { deviceBox } from "@/program/surroundings";
import {
  aligned,
  boxOf,
  moveBy,
  shifted,
  type Shifts,
  type Side,
  spread,
  type Standing,
  tidied,
} from "../edits/arranging";
import { sortByReading } from "../edits/clipping";
import type { OpenProgram } from "../state/context";
import { freeOn } from "../state/freeSpot";
import { command, needsRight, type Command, type On } from "./command";

/** The selected steps that stand in no other selected one, in reading order. */
function standing({ document, scene }: OpenProgram, steps: readonly string[]): Standing[] {
  return sortByReading(scene.tree, outermost(document, steps)).flatMap((id) => {
    const box = outerBox(scene, id);
    return box ? [{ id, box }] : [];
  });
}

function arranging(
  id: string,
  icon: Command["icon"],
  fewest: 2 | 3,
  shifts: (open: OpenProgram, steps: readonly Standing[]) => Shifts,
): Command {
  return command({
    id,
    group: "arrange",
    icon,
    when: "steps",
    menus: ["step"],
    whyNot: (open: OpenProgram, on: On) =>
      needsRight(open, on) ??
      (standing(open, on.steps).length >= fewest ? null : `commands.why.${fewest === 2 ? "two" : "three"}_steps`),
    run: (open, on) => open.apply(moveBy(open.document, shifts(open, standing(open, on.steps)))),
  });
}

const align = (side: Side) => (_open: OpenProgram, steps: readonly Standing[]) => aligned(steps, side);

/** Tidy where they stand, or where the nearest room for all of them is. */
function tidy(open: OpenProgram, steps: readonly Standing[]): Shifts {
  const shifts = tidied(steps);
  const block = boxOf(shifted(steps, shifts));
  const taken = others(open, steps);
  if (!taken.some((each) => overlaps(each, grown(block, 4)))) return shifts;
  const from = centre(block);
  const size = { width: block.right - block.left, height: block.bottom - block.top };
  const to = freeOn(open.plan, from, size, taken);
  return new Map([...shifts].map(([id, { x, y }]) => [id, { x: x + to.x - from.x, y: y + to.y - from.y }]));
}

/** Machines, and steps that stay. A frame around the steps grows with them. */
function others({ scene, devices }: OpenProgram, steps: readonly Standing[]): Box[] {
  const own = new Set(steps.map(({ id }) => id));
  const inOwn = (id: string) => scene.frames.some((frame) => own.has(frame.id) && frame.holds.has(id));
  const chips = [...scene.chips.values()].filter(({ id }) => !own.has(id) && !inOwn(id));
  const machines = devices.filter((device) => device.kind !== "robot");
  return [...chips.map((chip) => chip.box), ...machines.map(deviceBox)];
}

export const ARRANGE_COMMANDS: readonly Command[] = [
  arranging("align_left", AlignStartVertical, 2, align("left")),
  arranging("align_centre", AlignCenterVertical, 2, align("centre")),
  arranging("align_right", AlignEndVertical, 2, align("right")),
  arranging("align_top", AlignStartHorizontal, 2, align("top")),
  arranging("align_middle", AlignCenterHorizontal, 2, align("middle")),
  arranging("align_bottom", AlignEndHorizontal, 2, align("bottom")),
  arranging("spread_across", AlignHorizontalDistributeCenter, 3, (_open, steps) => spread(steps, "across")),
  arranging("spread_down", AlignVerticalDistributeCenter, 3, (_open, steps) => spread(steps, "down")),
  arranging("tidy", LayoutGrid, 2, tidy),
];
