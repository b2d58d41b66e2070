/** A gesture on the map from its first press to the step that it makes. */
import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import { toPixels, type Point } from "@/map/projection";
import type { PixelPoint } from "@/map/routePath";
import { ViewportCell } from "@/map/viewport";
import { useRoutes } from "../canvas/useRoutes";
import type { Load } from "../parts/LoadAsk";
import type { ProgramDocument, StepKind } from "../model/types";
import { freshName } from "../model/variables";
import { frameAt, type Frame } from "../scene/frames";
import { spotBelow, spotOnMachine, spotOnRoute } from "../scene/placing";
import { keyOfWay } from "../scene/routing";
import { outerBox, routePoints } from "../scene/scene";
import { deviceBox, spotOf, type SiteDevice, type Spot } from "../scene/surroundings";
import { branchNow, createStep } from "./actions";
import type { OpenProgram } from "./context";
import { askOf, operable, suggestedLoads, suits, withDevice, type Gesture } from "./tool";
import { say, useUi } from "./ui";

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
  const { surroundings, document, scene, apply, t, plan, site, devices } = open;
  const [pointer] = useState(() => new ViewportCell());
  const dragged = useRef<string | null>(null);
  const device = (id: string | null) => (id ? surroundings.devices.get(id) : undefined);
  const spot = (id: string | null) => (id ? spotOf({ device: id }, surroundings, document, null) : null);
  const [source, target] = [device(gesture.source), device(gesture.target)];
  const ends = waySpots(gesture, spot(gesture.source), spot(gesture.target));
  const key = ends ? keyOfWay(ends.from, ends.to) : "";
  const routes = useRoutes(
    site.slug,
    plan?.version,
    useMemo(() => (key ? [key] : []), [key]),
  );
  const preview = ends ? routePoints(ends, routes(key)) : null;
  const asks = askOf(gesture) === "load";
  const taken = [...scene.chips.values()].map((chip) => chip.box);
  const machines = devices.filter((each) => each.kind !== "robot").map(deviceBox);
  const role = { role: "robot" };

  const takeDevice = useCallback(
    (id: string) => {
      const found = surroundings.devices.get(id);
      if (!found || askOf(gesture) === "nothing") return;
      const from = gesture.source ? surroundings.devices.get(gesture.source) : undefined;
      if (!suits(gesture, found, from)) {
        if (askOf(gesture) === "floor") createOnFloor(open, gesture, spotOnMachine(deviceBox(found), taken));
        else say(t(`unsuitable.${askOf(gesture)}`, { device: found.name }));
        return;
      }
      createAtDevice(open, gesture, found, taken);
    },
    [surroundings, gesture, open, t, taken],
  );

  const takeLoad = (load: Load) => {
    const common = { ...role, ...presentOnly(load) };
    if (gesture.tool === "pick_and_drop" && preview && source && target)
      createStep(document, apply, {
        kind: "pick_and_drop",
        pos: spotOnRoute(preview, [...taken, ...machines]),
        params: { ...common, source: { device: source.id }, target: { device: target.id } },
      });
    const place = gesture.tool === "pick" ? source : gesture.tool === "drop" ? target : undefined;
    if (place && (gesture.tool === "pick" || gesture.tool === "drop"))
      createStep(document, apply, {
        kind: gesture.tool,
        pos: spotOnMachine(deviceBox(place), taken),
        params: { ...common, at: { device: place.id } },
      });
    say(t("made"), true);
  };

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
  const askSpot = target ?? source;
  useEffect(() => {
    if (gesture.tool === "call") useUi.setState({ dialog: "function" });
  }, [gesture.tool]);
  return {
    takeDevice,
    takeFloor: (at) => createOnFloor(open, gesture, at),
    takeLoad,
    dragFrom,
    dragTo,
    askAt: asks && askSpot ? below(askSpot) : null,
    loads: suggestedLoads(source, target, mostCarried(devices)),
    from: askOf(gesture) === "target" ? (spot(gesture.source)?.at ?? null) : null,
    preview: asks ? preview : null,
    pointer,
  };
}

function waySpots(gesture: Gesture, from: Spot | null, to: Spot | null): { from: Spot; to: Spot } | null {
  return gesture.tool === "pick_and_drop" && from && to ? { from, to } : null;
}

function below(device: SiteDevice): PixelPoint {
  const box = deviceBox(device);
  return { x: (box.left + box.right) / 2, y: box.bottom };
}

function mostCarried(devices: readonly SiteDevice[]): number {
  return Math.max(1, ...devices.map((device) => (device.kind === "robot" ? (device.capacity ?? 1) : 1)));
}

function presentOnly(load: Load): Record<string, unknown> {
  return Object.fromEntries(Object.entries(load).filter(([, value]) => value !== null));
}

function createAtDevice(
  open: OpenProgram,
  gesture: Gesture,
  device: SiteDevice,
  taken: Parameters<typeof spotOnMachine>[1],
): void {
  const pos = spotOnMachine(deviceBox(device), taken);
  const make = (kind: "move" | "operate", params: Record<string, unknown>) =>
    createStep(open.document, open.apply, { kind, pos, params });
  if (gesture.tool === "operate") {
    const methods = operable(device);
    const method = methods.length === 1 ? { method: methods[0]?.name } : {};
    make("operate", { device: { device: device.id }, ...method, args: {} });
  } else if (gesture.tool === "move") make("move", { role: "robot", to: { device: device.id } });
  else useUi.setState({ gesture: withDevice(gesture, device.id) });
}

/** What a fresh step of a kind that stands on the floor knows already; what cannot be guessed is left out. */
function freshParams(kind: string, document: ProgramDocument): Record<string, unknown> | null {
  switch (kind) {
    case "parallel":
      return { branches: ["a", "b"] };
    case "try":
      return { kinds: [] };
    case "for_each":
      return { variable: freshName(document, "item"), items: [] };
    case "ask":
      return { answer: { type: "boolean" }, variable: freshName(document, "answer") };
    case "notify":
      return { level: "info" };
    case "on_event":
      return { starts: "branch" };
    case "comment":
      return { text: "" };
    default:
      return PLAIN.includes(kind) ? {} : null;
  }
}

const PLAIN = ["wait", "if", "while", "repeat", "set", "end", "return", "break"];

/** The next step goes into the body of this frame. */
export function goInto(open: OpenProgram, frame: Frame): void {
  const word = open.t(`kind.${frame.kind}`);
  useUi.setState({ into: { branch: { parent: frame.id, branch: "body" }, link: `${frame.id}/body`, word } });
}

export function createOnFloor(open: OpenProgram, gesture: Gesture, at: Point): void {
  const { document, apply } = open;
  const frame = frameAt(open.scene.frames, toPixels(at));
  if (frame) goInto(open, frame);
  if (gesture.tool === "move") {
    createStep(document, apply, { kind: "move", pos: at, params: { role: "robot", to: nearestGoal(open, at) } });
    return;
  }
  const params = freshParams(gesture.tool, document);
  if (!params) return;
  const kind = gesture.tool as StepKind;
  const apart = kind === "on_event" || kind === "comment";
  const id = createStep(document, apply, { kind, pos: (apart ? null : insideFrame(open)) ?? at, params });
  if (kind === "on_event")
    useUi.setState({
      into: { branch: { parent: id, branch: "body" }, link: `${id}/body`, word: open.t("kind.on_event") },
    });
}

/** A step for a frame's body goes under what stands there already. */
function insideFrame(open: OpenProgram): Point | null {
  const { into } = useUi.getState();
  const branch = branchNow(open.document);
  if (!into || branch.branch !== "body") return null;
  const last = open.scene.tree.children(branch.parent, "body").at(-1);
  const box = outerBox(open.scene, last ?? branch.parent);
  return box ? spotBelow(box) : null;
}

/** A named place within 0.8 m of the press, or the very point. */
function nearestGoal(open: OpenProgram, at: Point): Record<string, unknown> {
  const near = open.plan?.places.find(
    (place) => place.kind !== "room" && Math.hypot(place.x - at[0], place.y - at[1]) < 0.8,
  );
  return near ? { place: near.id } : { point: at };
}
