/** Chips let go on the map: moved, put into a link, or put into a frame. */
import { toPixels, type Point } from "@/map/plane/projection";
import type { PixelPoint } from "@/map/plane/paths";
import type { MovedNode } from "@/program/canvas/useMovingNodes";
import { movedBy, takenAlong } from "../edits/arranging";
import type { Edit } from "../edits/edits";
import { liftOut } from "../edits/branches";
import { moveStep } from "../edits/joints";
import { frameAt } from "@/program/scene/frames";
import { boxAt, gap, nearestOn } from "@/program/scene/geometry";
import { START_ID } from "@/program/canvas/buildNodes";
import type { OpenProgram } from "../state/context";
import { say } from "../state/ui";
import { doAndSay } from "../state/undoing";

const ON_LINK = 14;
const OUTSIDE = 24;

export function moveChips(open: OpenProgram, moved: readonly MovedNode[]): void {
  const { document, apply } = open;
  const start = moved.find((each) => each.id === START_ID);
  const steps = moved.filter((each) => document.steps[each.id]);
  const edits: Edit[] = start ? [{ do: "set_start", pos: start.at }] : [];
  for (const { id, at } of steps) edits.push({ do: "set_pos", id, pos: at });
  edits.push(...carried(open, steps));
  const [only] = steps;
  const dropped = steps.length === 1 && only ? joined(open, only.id, only.pointed) : STAYS;
  const drop = () => apply([...edits, ...dropped.edits]);
  const { done } = dropped;
  if (done === undefined) drop();
  else doAndSay(open, drop, () => done);
}

interface Dropped {
  readonly edits: readonly Edit[];
  /** What is said of it, once it is done. */
  readonly done?: string;
}

const STAYS: Dropped = { edits: [] };

/** What stands inside a frame moves with its head. */
function carried(open: OpenProgram, moved: readonly { id: string; at: Point }[]): Edit[] {
  const { document } = open;
  const own = new Set(moved.map((each) => each.id));
  return moved.flatMap(({ id, at }) => {
    const before = document.steps[id]?.pos;
    if (!before) return [];
    const inner = [...takenAlong(open, id)].filter((each) => !own.has(each));
    return movedBy(document, new Set(inner), [at[0] - before[0], at[1] - before[1]]);
  });
}

/** Dropped on a dotted link: inserted there. Dropped into a frame: the last in it. Dragged out of one: behind it. */
function joined(open: OpenProgram, id: string, at: Point): Dropped {
  const { document, scene, t } = open;
  const point = toPixels(at);
  // What comes along is drawn where it stood, and is no goal there.
  const moving = new Set([id, ...takenAlong(open, id)]);
  const link = scene.links.find((each) => {
    if ([each.from, each.to, each.into.parent].some((end) => end !== null && moving.has(end))) return false;
    return (nearestOn(each.points, point)?.off ?? Infinity) < ON_LINK;
  });
  const others = scene.frames.filter((each) => !moving.has(each.id) && document.steps[id]?.place?.[0] !== each.id);
  const frame = frameAt(others, point);
  const goal = link
    ? { branch: link.into, after: link.after }
    : frame
      ? {
          branch: { parent: frame.id, branch: "body" },
          after: scene.tree.children(frame.id, "body").at(-1) ?? null,
        }
      : null;
  if (!goal) return draggedOut(open, id, point);
  const decision = moveStep(document, id, goal.branch, goal.after);
  if ("edits" in decision) return decision;
  if (decision.refused === "cycle") say(t("refused.cycle"));
  return STAYS;
}

/** A chip that stood inside its frame and now stands well outside it follows the frame. */
function draggedOut({ document, scene, t }: OpenProgram, id: string, point: PixelPoint): Dropped {
  const frame = scene.frames.find((each) => each.holds.has(id));
  if (!frame || gap(frame.box, boxAt(point, 0, 0)) < OUTSIDE) return STAYS;
  const decision = liftOut(document, [id]);
  if (!("edits" in decision)) return STAYS;
  return { edits: decision.edits, done: t("gesture.lifted", { frame: t(`kind.${frame.kind}`) }) };
}
