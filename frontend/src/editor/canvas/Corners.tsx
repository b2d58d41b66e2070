/** Corners on the map that are dragged, added between two others and taken away; by pointer and by keyboard. */
import { useReactFlow } from "@xyflow/react";
import { type KeyboardEvent, type PointerEvent, useState } from "react";
import type { PixelPoint } from "@/map/plane/paths";
import { toMetres, toPixels } from "@/map/plane/projection";
import stage from "@/program/canvas/stage.module.css";
import { nearestOn } from "@/program/scene/geometry";
import { useFingers } from "@/program/touch/fingers";
import { toCentimetre } from "../edits/clipping";
import type { Position } from "@/program/document/document";
import classes from "./gestures.module.css";

export interface CornersProps {
  readonly points: readonly Position[];
  /** A zone's outline, as against a route between two ends. */
  readonly closed: boolean;
  /** Where a route begins and ends; no handles of their own. */
  readonly ends?: readonly [PixelPoint, PixelPoint];
  readonly fewest: number;
  readonly nameOf: (number: number) => string;
  readonly nameOfNew: (number: number) => string;
  readonly onChange: (points: readonly Position[]) => void;
}

const NUDGES: Readonly<Record<string, Position>> = {
  ArrowLeft: [-0.1, 0],
  ArrowRight: [0.1, 0],
  ArrowUp: [0, 0.1],
  ArrowDown: [0, -0.1],
};

export function Corners(props: CornersProps) {
  const { points, onChange, fewest, ends } = props;
  const flow = useReactFlow();
  const { held, hold } = useHeldCorner(onChange);
  const shown = held?.points ?? points;
  const press = (event: KeyboardEvent, at: number) => {
    const direction = NUDGES[event.key];
    if (direction) onChange(pushed(points, at, direction));
    else if ((event.key === "Delete" || event.key === "Backspace") && points.length > fewest)
      onChange(withoutCorner(points, at));
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return (
    <>
      <svg className={`${stage.drawing} nopan nodrag`} width={1} height={1}>
        {ends ? (
          <path
            className={classes.grab}
            d={outlineOf(props, points)}
            onPointerDown={(event) => {
              const at = flow.screenToFlowPosition({ x: event.clientX, y: event.clientY });
              const leg = nearestLeg([ends[0], ...points.map(toPixels), ends[1]], at);
              hold(event, leg, withCorner(points, leg, toMetres(at)));
            }}
          />
        ) : null}
        {held ? <path className={classes.changing} d={outlineOf(props, shown)} /> : null}
        {held ? null : <Between {...props} onHold={hold} />}
      </svg>
      <svg className={`${stage.drawing} ${classes.over} nopan nodrag`} width={1} height={1}>
        {shown.map((point, at) => (
          <Corner
            key={at}
            at={toPixels(point)}
            name={props.nameOf(at + 1)}
            onHold={(event) => hold(event, at, shown)}
            onKey={(event) => press(event, at)}
            onRemove={() => points.length > fewest && onChange(withoutCorner(points, at))}
          />
        ))}
      </svg>
    </>
  );
}

interface Held {
  readonly at: number;
  readonly points: readonly Position[];
}

/** The corner under the pointer, followed over the whole window until it is let go; a second finger gives it up. */
function useHeldCorner(onChange: CornersProps["onChange"]) {
  const flow = useReactFlow();
  const [held, setHeld] = useState<Held | null>(null);
  const hold = (event: PointerEvent<SVGElement>, at: number, from: readonly Position[]) => {
    event.stopPropagation();
    if (useFingers.getState().several) return;
    let now: Held | null = null;
    const listening = new AbortController();
    const drag = ({ clientX, clientY, pointerId }: globalThis.PointerEvent) => {
      if (pointerId !== event.pointerId) return;
      const to = toMetres(flow.screenToFlowPosition({ x: clientX, y: clientY }));
      now = { at, points: from.map((point, index) => (index === at ? to : point)) };
      setHeld(now);
    };
    const end = () => {
      listening.abort();
      stop();
      setHeld(null);
    };
    const stop = useFingers.subscribe(({ several }) => several && end());
    const release = ({ type, pointerId }: globalThis.PointerEvent) => {
      if (pointerId !== event.pointerId) return;
      end();
      if (now && type === "pointerup") onChange(now.points);
    };
    window.addEventListener("pointermove", drag, { signal: listening.signal });
    window.addEventListener("pointerup", release, { signal: listening.signal });
    window.addEventListener("pointercancel", release, { signal: listening.signal });
  };
  return { held, hold };
}

function outlineOf({ closed, ends }: CornersProps, points: readonly Position[]): string {
  const all = [...(ends ? [ends[0]] : []), ...points.map(toPixels), ...(ends ? [ends[1]] : [])];
  return `M${all.map(({ x, y }) => `${x} ${y}`).join("L")}${closed ? "Z" : ""}`;
}

interface CornerProps {
  at: PixelPoint;
  name: string;
  onHold: (event: PointerEvent<SVGElement>) => void;
  onKey: (event: KeyboardEvent) => void;
  onRemove: () => void;
}

function Corner({ at, name, onHold, onKey, onRemove }: CornerProps) {
  return (
    <rect
      className={classes.handle}
      x={at.x - 5.5}
      y={at.y - 5.5}
      width={11}
      height={11}
      rx={2.5}
      role="button"
      tabIndex={0}
      aria-label={name}
      onPointerDown={onHold}
      onDoubleClick={(event) => {
        // On the map it would ask for a construct.
        event.stopPropagation();
        onRemove();
      }}
      onKeyDown={onKey}
    >
      <title>{name}</title>
    </rect>
  );
}

type Hold = (event: PointerEvent<SVGElement>, at: number, from: readonly Position[]) => void;

/** A dot on the middle of each side: drag it, or press Enter on it, for one corner more. */
function Between({ points, closed, ends, nameOfNew, onChange, onHold }: CornersProps & { onHold: Hold }) {
  const all = [...(ends ? [ends[0]] : []), ...points.map(toPixels), ...(ends ? [ends[1]] : [])];
  const following = closed ? [...all.slice(1), ...all.slice(0, 1)] : all.slice(1);
  return following.map((b, index) => {
    const a = all[index] ?? b;
    if (Math.hypot(b.x - a.x, b.y - a.y) < 34) return null;
    const middle = { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
    const at = ends ? index : index + 1;
    const more = withCorner(points, at, toMetres(middle));
    return (
      <circle
        key={index}
        className={classes.handle}
        data-between
        cx={middle.x}
        cy={middle.y}
        r={4.5}
        role="button"
        tabIndex={0}
        aria-label={nameOfNew(at)}
        onPointerDown={(event) => onHold(event, at, more)}
        onKeyDown={(event) => {
          if (event.key !== "Enter" && event.key !== " ") return;
          event.preventDefault();
          event.stopPropagation();
          onChange(more);
        }}
      >
        <title>{nameOfNew(at)}</title>
      </circle>
    );
  });
}

export function pushed(points: readonly Position[], at: number, [dx, dy]: Position): Position[] {
  return points.map((point, index) =>
    index === at ? [toCentimetre(point[0] + dx), toCentimetre(point[1] + dy)] : point,
  );
}

export function withCorner(points: readonly Position[], at: number, corner: Position): Position[] {
  return [...points.slice(0, at), corner, ...points.slice(at)];
}

export function withoutCorner(points: readonly Position[], at: number): Position[] {
  return points.filter((_, index) => index !== at);
}

/** Which leg of a path a point lies nearest to; 0 is the first. */
export function nearestLeg(path: readonly PixelPoint[], to: PixelPoint): number {
  const far = path.slice(1).map((end, index) => nearestOn([path[index] ?? end, end], to)?.off ?? Infinity);
  return Math.max(0, far.indexOf(Math.min(...far)));
}
