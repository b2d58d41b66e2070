/** Zones on the map: hatched, with their rule; the selected one with its corners, a new one as it is drawn. */
import { useEffect, useRef } from "react";
import { toPixels } from "@/map/plane/projection";
import type { ViewportCell } from "@/map/plane/viewport";
import stage from "@/program/canvas/stage.module.css";
import { CornerHandles } from "../canvas/CornerHandles";
import { useGestures, selectZone } from "../state/gestures";
import type { Position } from "@/program/document/document";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import { changeZone } from "./zoneTool";
import { FEWEST_CORNERS, placed, soundZones, Zones } from "@/program/canvas/Zones";
import classes from "./zones.module.css";

/** Over everything: the handles of the selected zone and the one being drawn. */
export function ZoneHandles({ pointer }: { pointer: ViewportCell }) {
  const open = useOpenProgram();
  const { document, canEdit, t } = open;
  const id = useGestures((ui) => ui.zone);
  const corners = useGestures((ui) => ui.corners);
  const resting = useUi((ui) => ui.gesture.tool === "select");
  const [, zone] = soundZones(document).find(([each]) => each === id) ?? [null, null];
  if (corners.length > 0) return <Corners corners={corners} pointer={pointer} />;
  if (!zone || id === null || !canEdit || !resting) return null;
  return (
    <CornerHandles
      points={zone.points}
      closed
      fewest={FEWEST_CORNERS}
      nameOf={(number) => t("gesture.zone.corner", { number, name: zone.name })}
      nameOfNew={(number) => t("gesture.zone.new_corner", { number })}
      onChange={(points) => changeZone(open, id, { points })}
    />
  );
}

/** The corners so far and the line to the pointer. */
function Corners({ corners, pointer }: { corners: readonly Position[]; pointer: ViewportCell }) {
  const line = useRef<SVGLineElement>(null);
  const points = corners.map(toPixels);
  const last = points.at(-1);
  useEffect(() => {
    const follow = () => {
      const { x, y } = pointer.get();
      line.current?.setAttribute("x2", String(x));
      line.current?.setAttribute("y2", String(y));
    };
    follow();
    return pointer.subscribe(follow);
  }, [pointer, corners]);
  return (
    <svg className={stage.drawing} width={1} height={1} aria-hidden="true">
      <g className={classes.fresh}>
        <path d={`M${points.map(placed).join("L")}`} />
        {last ? <line ref={line} x1={last.x} y1={last.y} x2={last.x} y2={last.y} /> : null}
        {points.map((point, index) => (
          <circle key={index} cx={point.x} cy={point.y} r={index === 0 ? 7 : 4} />
        ))}
      </g>
    </svg>
  );
}

/** What a press on a zone's edge or name does in the editor. */
export function EditorZones() {
  const { document, t } = useOpenProgram();
  const selected = useGestures((ui) => ui.zone);
  const resting = useUi((ui) => ui.gesture.tool === "select");
  return <Zones document={document} t={t} selected={selected} onSelect={resting ? selectZone : undefined} />;
}
