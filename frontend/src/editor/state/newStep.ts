/** New steps where a gesture ends: at a device or on the floor. */
import type { MapPlace } from "@/map/floor/floor";
import { toPixels, type Box, type Point } from "@/map/plane/projection";
import type { ProgramDocument, StepKind } from "@/program/document/document";
import { type FieldRecord, fieldsOf, isStepKind } from "@/program/kinds";
import { freshName } from "../edits/variables";
import { frameAt, type Frame } from "@/program/scene/frames";
import { spotBelow, spotByRobot, spotOnMachine } from "./placement";
import { zoneAt } from "@/program/scene/coverLanes";
import { outerBox } from "@/program/scene/scene";
import { operable } from "@/program/operation";
import { deviceBox, type SiteDevice } from "@/program/surroundings";
import { branchNow, createStep, intoNow } from "./actions";
import type { OpenProgram } from "./context";
import { freeSpot } from "./freeSpot";
import { chooseBranch, openBranchAt } from "./nextPlace";
import { withDevice, type Gesture } from "./tool";
import { useUi } from "./ui";

/** A step at a machine or a robot; an Operate of its only method, where none is given. */
export function createAtDevice(
  open: OpenProgram,
  gesture: Gesture,
  device: SiteDevice,
  taken: readonly Box[],
  chosen?: string,
): void {
  const pos = device.kind === "robot" ? besideRobot(open, device, taken) : spotOnMachine(deviceBox(device), taken);
  const make = (kind: "move" | "operate", params: Record<string, unknown>) =>
    createStep(open.document, open.apply, { kind, pos, params });
  if (gesture.tool === "operate") {
    const methods = operable(device);
    const name = chosen ?? (methods.length === 1 ? methods[0]?.name : undefined);
    const method = name === undefined ? {} : { method: name };
    make("operate", { device: operatedBy(open.document, device), ...method, args: {} });
  } else if (gesture.tool === "move") make("move", { role: "robot", to: { device: device.id } });
  else useUi.setState({ gesture: withDevice(gesture, device.id) });
}

/** A Move to a named place. */
export function createAtPlace(open: OpenProgram, { id, x, y }: MapPlace): void {
  const params = { role: "robot", to: { place: id } };
  createStep(open.document, open.apply, { kind: "move", pos: freeSpot(open, "move", [x, y]), params });
}

function besideRobot({ devices }: OpenProgram, robot: SiteDevice, taken: readonly Box[]): Point {
  const robots = devices.filter((each) => each.kind === "robot").map(deviceBox);
  return spotByRobot(deviceBox(robot), [...taken, ...robots]);
}

/** A robot that the program has already goes by its role there. */
export function operatedBy(document: ProgramDocument, device: SiteDevice): Record<string, string> {
  const role = Object.entries(document.roles).find(([, each]) => each.device === device.id);
  return device.kind === "robot" && role ? { role: role[0] } : { device: device.id };
}

/** What a fresh step of a kind that stands on the floor knows already; what cannot be guessed is left out. */
export function freshParams(kind: string, document: ProgramDocument): Record<string, unknown> | null {
  const fields = fieldsOf(kind);
  if (!isStepKind(kind) || fields.some(({ type }) => type === "place" || type === "function")) return null;
  const known = fields.map((field) => [field.name, freshValue(field, document)] as const);
  return Object.fromEntries(known.filter(([, value]) => value !== undefined));
}

function freshValue({ type, choices, suggested }: FieldRecord, document: ProgramDocument): unknown {
  if (suggested) return freshName(document, suggested);
  return type === "choice" ? choices?.[0] : FRESH[type];
}

const FRESH: Readonly<Record<string, unknown>> = {
  branches: ["a", "b"],
  choices: [],
  values: [],
  answer: { type: "boolean" },
  text: "",
};

/** The next step goes into the body of this frame. */
export function goInto(open: OpenProgram, frame: Frame): void {
  const word = open.t(`kind.${frame.kind}`);
  useUi.setState({ into: { branch: { parent: frame.id, branch: "body" }, link: `${frame.id}/body`, word } });
}

/** The next step goes into the open branch or the frame at this point; false where there is none. */
export function goIntoAt(open: OpenProgram, at: Point): boolean {
  const branch = openBranchAt(open.scene.links, at);
  const frame = frameAt(open.scene.frames, toPixels(at));
  if (branch) chooseBranch(open, branch);
  else if (frame) goInto(open, frame);
  return (branch ?? frame) !== null;
}

export function createOnFloor(open: OpenProgram, gesture: Gesture, at: Point): void {
  const { document, apply } = open;
  goIntoAt(open, at);
  if (gesture.tool === "move") {
    createStep(document, apply, { kind: "move", pos: at, params: { role: "robot", to: nearestGoal(open, at) } });
    return;
  }
  const params = freshParams(gesture.tool, document);
  if (!params) return;
  const kind = gesture.tool as StepKind;
  if (kind === "cover") params.zone = zoneAt(document, at) ?? onlyZone(document);
  const apart = kind === "on_event" || kind === "comment";
  const id = createStep(document, apply, { kind, pos: (apart ? null : insideFrame(open)) ?? at, params });
  if (kind === "on_event")
    useUi.setState({
      into: { branch: { parent: id, branch: "body" }, link: `${id}/body`, word: open.t("kind.on_event") },
    });
}

function onlyZone(document: ProgramDocument): string | null {
  const [only, second] = Object.keys(document.zones);
  return second === undefined ? (only ?? null) : null;
}

/** A step for a frame's body goes under what stands there already. */
function insideFrame(open: OpenProgram): Point | null {
  const branch = branchNow(open.document);
  if (!intoNow(open.document) || branch.branch !== "body") return null;
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
