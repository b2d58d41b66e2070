/** Zones on the map: hatched, with their rule; the selected one with its corners, a new one as it is drawn. */
import { useEffect, useRef } from "react";
import { boxAround, toPixels } from "@/map/projection";
import type { PixelPoint } from "@/map/routePath";
import type { ViewportCell } from "@/map/viewport";
import { VipoIcon } from "@/design/VipoIcon";
import stage from "../canvas/stage.module.css";
import { CornerHandles } from "../gestures/CornerHandles";
import { useGestures } from "../gestures/store";
import type { Position } from "../model/edits";
import type { ProgramDocument, Zone } from "../model/types";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import type { Translate } from "../scene/words";
import { changeZone, selectZone } from "./drawing";
import { FEWEST_CORNERS, soundZones } from "./shape";
import classes from "./zones.module.css";

interface ZonesProps {
  document: ProgramDocument;
  t: Translate;
  selected?: string | null;
  onSelect?: (zone: string) => void;
}

/** Under everything that is drawn. */
export function Zones({ document, t, selected = null, onSelect }: ZonesProps) {
  return (
    <svg className={stage.drawing} width={1} height={1}>
      <defs>
        <pattern id="zone-hatch" width={11} height={11} patternUnits="userSpaceOnUse" patternTransform="rotate(45)">
          <line x1={0} y1={0} x2={0} y2={11} className={classes.hatch} />
        </pattern>
      </defs>
      {soundZones(document).map(([id, zone]) => (
        <ZoneShape key={id} zone={zone} selected={selected === id} t={t} onSelect={onSelect && (() => onSelect(id))} />
      ))}
    </svg>
  );
}

function ZoneShape(props: { zone: Zone; selected: boolean; t: Translate; onSelect?: () => void }) {
  const { zone, selected, t, onSelect } = props;
  const outline = `M${zone.points.map(toPixels).map(placed).join("L")}Z`;
  const box = boxAround(zone.points.map(toPixels));
  const words = zoneWords(zone, t);
  return (
    <g
      className={classes.zone}
      data-rule={zone.rule}
      data-selected={selected || undefined}
      data-pressable={onSelect ? true : undefined}
    >
      <path d={outline} className={classes.area} />
      <path d={outline} className={classes.edge} onClick={onSelect} />
      {box ? (
        <foreignObject className={classes.words} x={box.left + 6} y={box.bottom - 28} width={60} height={24}>
          <button type="button" className={classes.tag} onClick={onSelect} tabIndex={onSelect ? 0 : -1}>
            <VipoIcon name="zone" size={13} />
            <span>{words}</span>
          </button>
        </foreignObject>
      ) : null}
    </g>
  );
}

export function zoneWords(zone: Zone, t: Translate): string {
  const name = String(zone.name ?? "");
  if (zone.rule === "keep_out") return t("gesture.zone.say_keep_out", { name });
  if (zone.rule === "one_at_a_time") return t("gesture.zone.say_one_at_a_time", { name });
  return t("gesture.zone.say_slow", { name, speed: `${zone.speed_m_s ?? "?"}\u202fm/s` });
}

function placed({ x, y }: PixelPoint): string {
  return `${x} ${y}`;
}

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
