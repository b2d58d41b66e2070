/** A small read-only map: floor, devices and, if given, routes. */
import { type ReactNode, type RefObject, type SVGProps, useEffect, useMemo, useState } from "react";
import { footprint, type MapDevice } from "./devices/device";
import { DeviceGlyph } from "./devices/DeviceToken";
import { boxOfDevices, NAME_SIZE, nameOnMap, nameSize } from "./devices/framing";
import { type FloorPlan, knownBox } from "./floor/floor";
import { FloorCanvas } from "./floor/FloorCanvas";
import type { FloorDetail, Underlay } from "./floor/floorPainter";
import classes from "./map.module.css";
import { PathLine } from "./PathLine";
import { type Box, fitViewport, type Point, toPixels, type Viewport } from "./plane/projection";
import { useSize } from "./plane/useSize";
import { RobotLayer } from "./robots/RobotLayer";
import type { RobotSource } from "./robots/robots";
import { ViewportCell } from "./plane/viewport";
import { ZoomContext } from "./plane/zoom";

/** How large names are at least, in pixels of the screen: larger ones would lie over each other on a small map. */
const LEAST_NAME = 8.5;
const QUIET: FloorDetail = { rulers: false, labels: false, grid: true };
const NAMED: FloorDetail = { rulers: false, labels: true, grid: true };

/** How a map fits its pane, in pixels of the screen; its frame in drawing pixels. */
export interface Fitted {
  readonly fit: Viewport;
  readonly frame: Box;
  readonly width: number;
  readonly height: number;
}

/** A view that somebody moves: `view` holds as long as the map fits as in `of`. */
export interface SeenMap {
  readonly of: Viewport;
  readonly view: Viewport;
  readonly isNearer: boolean;
  readonly report: (fitted: Fitted) => void;
  readonly surface: RefObject<SVGSVGElement | null>;
  /** Pixels at the lower edge that are covered by what stands over the map. */
  readonly below: number;
  readonly handlers: SVGProps<SVGSVGElement>;
}

export interface StaticMapProps {
  plan: FloorPlan | null;
  devices?: readonly MapDevice[];
  /** Metres. */
  routes?: readonly (readonly Point[])[];
  /** Show only this part (drawing pixels); the whole known floor when left out. */
  focus?: Box;
  selected?: string | null;
  onSelect?: (device: string) => void;
  /** Rooms' names and devices' names. */
  named?: boolean;
  label: string;
  /** Robots that move, instead of standing among the devices. */
  robots?: RobotSource;
  /** What is painted on the floor itself. */
  under?: Underlay | null;
  /** How it is seen, where people come nearer. */
  seen?: SeenMap;
  /** Whether things are dragged or drawn on it: a finger then does that, instead of scrolling the page. */
  editing?: boolean;
  /** More to draw in drawing pixels, above the devices. */
  children?: ReactNode;
}

export function StaticMap(props: StaticMapProps) {
  const { plan, devices = [], routes = [], focus, named = false, label } = props;
  const [element, { width, height }] = useSize<HTMLDivElement>();
  const [cell] = useState(() => new ViewportCell());
  const { seen } = props;
  const below = seen?.below ?? 0;
  const known = useMemo(() => focus ?? (plan ? knownBox(plan) : null), [plan, focus]);
  const { left, top, right, bottom } = known ?? boxOfDevices(devices);
  const fit = useMemo(
    () => staticView({ left, top, right, bottom }, width, height, below),
    [left, top, right, bottom, width, height, below],
  );
  const view = seen?.of === fit ? seen.view : fit;
  const report = seen?.report;
  useEffect(
    () => report?.({ fit, frame: { left, top, right, bottom }, width, height }),
    [report, fit, left, top, right, bottom, width, height],
  );
  useEffect(() => cell.set(view), [cell, view]);
  const stop = (devices.find((device) => device.id === props.selected) ?? devices[0])?.id;
  return (
    <div ref={element} className={classes.static} role="group" aria-label={label}>
      <FloorCanvas plan={plan} viewport={cell} detail={named ? NAMED : QUIET} under={props.under} />
      <svg
        ref={seen?.surface}
        className={classes.still}
        data-nearer={seen?.isNearer || undefined}
        data-editing={props.editing || undefined}
        {...seen?.handlers}
        aria-hidden={props.onSelect || props.children ? undefined : true}
      >
        <g transform={`translate(${view.x} ${view.y}) scale(${view.zoom})`}>
          {routes.map((route, index) => (
            <PathLine key={index} points={route.map(toPixels)} />
          ))}
          {devices.map((device) => (
            <StaticDevice
              key={device.id}
              device={device}
              {...props}
              named={named}
              zoom={view.zoom}
              stop={device.id === stop}
            />
          ))}
          <ZoomContext value={view.zoom}>{props.children}</ZoomContext>
        </g>
      </svg>
      {props.robots ? <RobotLayer source={props.robots} viewport={cell} isTaken={nowhere} /> : null}
    </div>
  );
}

const nowhere = () => false;

function staticView(frame: Box, width: number, height: number, below: number): Viewport {
  if (width === 0) return { x: 0, y: 0, zoom: 1 };
  const margin = Math.min(16, width / 20);
  return fitViewport(frame, width, height, {
    left: margin,
    right: margin,
    top: margin,
    bottom: margin + below,
  });
}

interface StaticDeviceProps extends Pick<StaticMapProps, "selected" | "onSelect"> {
  device: MapDevice;
  named: boolean;
  zoom: number;
  /** Whether Tab stops at it; from there the arrow keys lead to the others. */
  stop: boolean;
}

function StaticDevice({ device, selected, onSelect, named, zoom, stop }: StaticDeviceProps) {
  const at = toPixels([device.location.x, device.location.y]);
  const chosen = selected === device.id;
  const choose = onSelect ? () => onSelect(device.id) : undefined;
  const label = named || chosen ? <DeviceName device={device} chosen={chosen} zoom={zoom} /> : null;
  const body = (
    <>
      {chosen ? <circle r={28} fill="none" stroke="var(--brand)" strokeWidth={3} /> : null}
      <DeviceGlyph device={device} plain />
      {label}
    </>
  );
  if (!choose) return <g transform={`translate(${at.x} ${at.y})`}>{body}</g>;
  return (
    <g
      transform={`translate(${at.x} ${at.y})`}
      className={classes.device}
      role="button"
      tabIndex={stop ? 0 : -1}
      aria-label={device.name}
      aria-pressed={chosen}
      onClick={choose}
      onKeyDown={(event) => {
        if (event.key === "Enter" || event.key === " ") choose();
        else if (!walk(event.currentTarget, event.key)) return;
        event.preventDefault();
      }}
    >
      {body}
    </g>
  );
}

function DeviceName({ device, chosen, zoom }: { device: MapDevice; chosen: boolean; zoom: number }) {
  const size = chosen ? nameSize(zoom) : Math.max(NAME_SIZE, LEAST_NAME / zoom);
  return (
    <text
      className={classes.label}
      y={footprint(device).height / 2 + size + 6}
      textAnchor="middle"
      aria-hidden="true"
      style={{ fontSize: size, ...(chosen ? { fill: "var(--brand-ink)" } : {}) }}
    >
      {nameOnMap(device.name)}
    </text>
  );
}

const WAYS: Readonly<Record<string, (at: number, count: number) => number>> = {
  ArrowRight: (at, count) => (at + 1) % count,
  ArrowDown: (at, count) => (at + 1) % count,
  ArrowLeft: (at, count) => (at + count - 1) % count,
  ArrowUp: (at, count) => (at + count - 1) % count,
  Home: () => 0,
  End: (_, count) => count - 1,
};

/** Give the focus to the next of the buttons among which `element` stands; false for any other key. */
export function walk(element: Element, key: string): boolean {
  const way = WAYS[key];
  const all = [...(element.parentElement?.querySelectorAll<SVGElement>(":scope > [role=button]") ?? [])];
  const at = all.indexOf(element as SVGElement);
  if (!way || at < 0) return false;
  all[way(at, all.length)]?.focus();
  return true;
}
