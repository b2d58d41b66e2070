/** A construct drawn where it was dropped or chosen: at a machine, on an arrow, in a frame or on the bare floor. */
import type { Link } from "@/program/scene/links";
import type { Under } from "./under";
import type { OpenProgram } from "./context";
import { openEnds } from "./freeSpot";
import { createAtDevice, createOnFloor } from "./newStep";
import { askOf, RESTING, suits, takeTool, type Gesture } from "./tool";
import { ZONE_TOOL } from "./tools";
import { say, useUi } from "./ui";

/** What cannot be set down there stays in hand and asks for what is missing. */
export function drawAt(open: OpenProgram, kind: string, { device, link, at }: Under): void {
  const gesture = takeTool(RESTING, kind, false);
  useUi.setState({ gesture });
  if (kind === ZONE_TOOL) return;
  if (link) drawOnLink(open, link);
  const ask = askOf(gesture);
  if (device !== null && ask !== "floor" && ask !== "function") drawAtDevice(open, gesture, device);
  else if (ask === "floor" || ask === "goal") createOnFloor(open, gesture, at);
}

function drawAtDevice(open: OpenProgram, gesture: Gesture, id: string): void {
  const device = open.surroundings.devices.get(id);
  if (!device) return;
  const chips = [...open.scene.chips.values()].map((chip) => chip.box);
  if (suits(gesture, device, undefined)) createAtDevice(open, gesture, device, [...chips, ...openEnds(open.scene)]);
  else say(open.t(`unsuitable.${askOf(gesture)}`, { device: device.name }));
}

/** The next step goes between the two that the arrow joins. */
export function drawOnLink({ t }: Pick<OpenProgram, "t">, link: Link): void {
  useUi.setState({
    into: { branch: link.into, link: link.id, word: link.word ?? t("then"), after: link.after },
  });
}
