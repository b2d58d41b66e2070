/** The lanes of the selected cover in light lines: the way there and back, and how far beside it it reaches. */
import { toPixels } from "@/map/plane/projection";
import { lanesOf } from "@/program/scene/coverLanes";
import { placed } from "@/program/canvas/Zones";
import stage from "@/program/canvas/stage.module.css";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import classes from "./gestures.module.css";

export function LanePreview() {
  const { document, devices } = useOpenProgram();
  const [id, second] = useUi((ui) => ui.selected);
  if (id === undefined || second !== undefined) return null;
  const lanes = lanesOf(document.steps[id], document, devices);
  if (!lanes) return null;
  const lines = lanes.lines.map((line) => `M${line.map(toPixels).map(placed).join("L")}`).join("");
  const [from, to] = [toPixels([0, 0]), toPixels([lanes.width, 0])];
  return (
    <svg className={stage.drawing} width={1} height={1} aria-hidden="true" data-lanes={lanes.lines.length}>
      <path d={lines} className={classes.swath} strokeWidth={to.x - from.x} />
      <path d={lines} className={classes.lane} />
    </svg>
  );
}
