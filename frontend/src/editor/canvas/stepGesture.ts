/** A gesture on the map from its first press to the step that it makes. */
import { useEffect, useMemo, useRef, useState } from "react";
import type { Box, Point } from "@/map/plane/projection";
import type { PixelPoint } from "@/map/plane/paths";
import { ViewportCell } from "@/map/plane/viewport";
import { useRoutes } from "@/program/canvas/useRoutes";
import type { Load } from "./LoadAsk";
import { spotOnMachine, spotOnRoute } from "../state/placement";
import { keyOfPath, type RouteLookup } from "@/program/scene/stepPaths";
import { routePoints } from "@/program/scene/scene";
import { deviceBox, spotOf, type SiteDevice, type Spot } from "@/program/surroundings";
import { floorMark } from "@/map/floor/floor";
import { createStep } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { createAtDevice, createOnFloor } from "../state/newStep";
import { openEnds } from "../state/freeSpot";
import { type Landing, useLanding } from "./landing";
import { askOf, suggestedLoads, suits, withDevice, type Gesture } from "../state/tool";
import { say, useUi } from "../state/ui";
import { doAndSay } from "../state/undoing";

export interface Drawing {
  readonly takeDevice: (device: string) => void;
  readonly takeFloor: (at: Point) => void;
  readonly takeLoad: (load: Load) => void;
  readonly dragFrom: (device: string) => void;
  readonly dragTo: (device: string) => void;
  /** Where the load is asked for, while it is. */
  readonly askAt: PixelPoint | null;
  readonly loads: readonly { quantity: number; object: string }[];
  /** The line from the source to the pointer. */
  readonly from: PixelPoint | null;
  readonly preview: readonly PixelPoint[] | null;
  readonly pointer: ViewportCell;
}

export function useDrawing(open: OpenProgram, gesture: Gesture): Drawing {
  const { surroundings, devices } = open;
  const [pointer] = useState(() => new ViewportCell());
  const path = usePath(open, gesture);
  const takeLoad = useTakeLoad(open, gesture, path);
  const takeDevice = (id: string) => takeDeviceFor(open, gesture, id);
  const drags = useDrags(open, gesture, takeDevice);
  const device = (id: string | null) => (id ? surroundings.devices.get(id) : undefined);
  const [source, target] = [device(gesture.source), device(gesture.target)];
  const asked = askOf(gesture) === "load" ? (target ?? source) : undefined;
  useEffect(() => {
    if (gesture.tool === "call") useUi.setState({ dialog: "function" });
  }, [gesture.tool]);
  return {
    takeDevice,
    takeFloor: (at) => createOnFloor(open, gesture, at),
    takeLoad,
    ...drags,
    askAt: asked ? below(asked) : null,
    loads: suggestedLoads(source, target, mostCarried(devices)),
    from: askOf(gesture) === "target" ? (spotOfDevice(open, gesture.source)?.at ?? null) : null,
    preview: asked ? path.preview : null,
    pointer,
  };
}

interface DrawnPath {
  readonly ends: { readonly from: Spot; readonly to: Spot } | null;
  readonly key: string;
  readonly routes: RouteLookup;
  /** From edge to edge, roughly while the server has not answered. */
  readonly preview: PixelPoint[] | null;
}

/** The path of a Pick-and-Drop as far as its ends are chosen. */
function usePath(open: OpenProgram, gesture: Gesture): DrawnPath {
  const ends = endsOf(open, gesture);
  const key = ends ? keyOfPath(ends.from, ends.to) : "";
  const routes = useRoutes(
    open.site.slug,
    floorMark(open.plan),
    useMemo(() => (key ? [key] : []), [key]),
  );
  return { ends, key, routes, preview: ends ? routePoints(ends, routes(key)) : null };
}

function endsOf(open: OpenProgram, gesture: Gesture): DrawnPath["ends"] {
  const [from, to] = [spotOfDevice(open, gesture.source), spotOfDevice(open, gesture.target)];
  return gesture.tool === "pick_and_drop" && from && to ? { from, to } : null;
}

function spotOfDevice({ surroundings, document }: OpenProgram, id: string | null): Spot | null {
  return id ? spotOf({ device: id }, surroundings, document, null) : null;
}

export function chipBoxes({ scene }: OpenProgram): Box[] {
  return [...[...scene.chips.values()].map((chip) => chip.box), ...openEnds(scene)];
}

function takeDeviceFor(open: OpenProgram, gesture: Gesture, id: string): void {
  const { surroundings, t } = open;
  const found = surroundings.devices.get(id);
  if (!found || askOf(gesture) === "nothing") return;
  const from = gesture.source ? surroundings.devices.get(gesture.source) : undefined;
  const taken = chipBoxes(open);
  if (suits(gesture, found, from)) createAtDevice(open, gesture, found, taken);
  else if (askOf(gesture) === "floor") createOnFloor(open, gesture, spotOnMachine(deviceBox(found), taken));
  else say(t(`unsuitable.${askOf(gesture)}`, { device: found.name }));
}

/** A Pick-and-Drop on its path; on one that is not known yet it is moved when the path comes. */
export function createTask(
  open: OpenProgram,
  ends: { readonly from: Spot; readonly to: Spot },
  load: { readonly [Name in keyof Load]: unknown },
  routes: RouteLookup,
  land: (landing: Landing) => void,
): void {
  const key = keyOfPath(ends.from, ends.to);
  const machines = open.devices.filter((device) => device.kind !== "robot").map(deviceBox);
  const pos = spotOnRoute(routePoints(ends, routes(key)), [...chipBoxes(open), ...machines]);
  const params = { role: "robot", ...presentOnly(load), source: ends.from.place, target: ends.to.place };
  const id = createStep(open.document, open.apply, { kind: "pick_and_drop", pos, params });
  if (routes(key) === undefined) land({ id, pos, key, ends });
}

/** The answer to what is carried makes the step. */
function useTakeLoad(open: OpenProgram, gesture: Gesture, path: DrawnPath) {
  const { document, apply, surroundings, t } = open;
  const land = useLanding(open, path.routes);
  return (load: Load) => {
    const common = { role: "robot", ...presentOnly(load) };
    const taken = chipBoxes(open);
    const at = gesture.tool === "pick" ? gesture.source : gesture.tool === "drop" ? gesture.target : null;
    const place = at === null ? undefined : surroundings.devices.get(at);
    const make = () => {
      if (path.ends) createTask(open, path.ends, load, path.routes, land);
      if (place && (gesture.tool === "pick" || gesture.tool === "drop"))
        createStep(document, apply, {
          kind: gesture.tool,
          pos: spotOnMachine(deviceBox(place), taken),
          params: { ...common, at: { device: place.id } },
        });
    };
    doAndSay(open, make, () => t("made"));
  };
}

/** Press on the source, let go on the target. */
function useDrags({ surroundings }: OpenProgram, gesture: Gesture, takeDevice: (device: string) => void) {
  const dragged = useRef<string | null>(null);
  const dragTo = (id: string) => {
    if (dragged.current && dragged.current !== id && askOf(gesture) === "target") takeDevice(id);
    dragged.current = null;
  };
  const dragFrom = (id: string) => {
    dragged.current = null;
    const found = surroundings.devices.get(id);
    if (askOf(gesture) !== "source" || !found || !suits(gesture, found, undefined)) return;
    dragged.current = id;
    useUi.setState({ gesture: withDevice(gesture, id) });
  };
  return { dragFrom, dragTo };
}

function below(device: SiteDevice): PixelPoint {
  const box = deviceBox(device);
  return { x: (box.left + box.right) / 2, y: box.bottom };
}

function mostCarried(devices: readonly SiteDevice[]): number {
  return Math.max(1, ...devices.map((device) => (device.kind === "robot" ? (device.capacity ?? 1) : 1)));
}

function presentOnly(load: { readonly [Name in keyof Load]: unknown }): Record<string, unknown> {
  return Object.fromEntries(Object.entries(load).filter(([, value]) => value !== null));
}
