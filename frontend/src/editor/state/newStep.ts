/** New steps where a gesture ends: at a device or on the floor. */
import { toPixels, type Box, type Point } from "@/map/plane/projection";
import type { ProgramDocument, StepKind } from "@/program/document/document";
import { freshName } from "../edits/variables";
import { frameAt, type Frame } from "@/program/scene/frames";
import { spotBelow, spotOnMachine } from "./placement";
import { outerBox } from "@/program/scene/scene";
import { deviceBox, type SiteDevice } from "@/program/surroundings";
import { branchNow, createStep } from "./actions";
import type { OpenProgram } from "./context";
import { operable, withDevice, type Gesture } from "./tool";
import { useUi } from "./ui";

export function createAtDevice(open: OpenProgram, gesture: Gesture, device: SiteDevice, taken: readonly Box[]): void {
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
