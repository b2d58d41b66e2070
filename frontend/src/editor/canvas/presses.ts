/** What lies under a press on the stage. */
import type { Node } from "@xyflow/react";
import type { PointerEvent } from "react";
import { DEVICE_PREFIX, START_ID } from "./buildNodes";
import type { MapStageProps, StagePress } from "./stageProps";

export function clickNode(props: MapStageProps, node: Node, press: StagePress): void {
  if (node.id.startsWith(DEVICE_PREFIX)) props.onDevice?.(node.id.slice(DEVICE_PREFIX.length), press);
  else if (node.id !== START_ID) props.onStep?.(node.id, press.add);
}

/** The machine whose node an event happened on. */
export function deviceUnder(event: PointerEvent): string | null {
  const under = document.elementFromPoint(event.clientX, event.clientY);
  const id = under?.closest(".react-flow__node")?.getAttribute("data-id");
  return id?.startsWith(DEVICE_PREFIX) ? id.slice(DEVICE_PREFIX.length) : null;
}
