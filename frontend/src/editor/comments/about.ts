/** What a thread is about: in the words of who looks, where it is on the map, and whether it is still there. */
import i18next from "i18next";
import type { Thread, ThreadToStart } from "@/api/types";
import { formatNumber } from "@/i18n/format";
import { pathLength, type PixelPoint, pointAlong } from "@/map/plane/paths";
import { momentOf, momentWords } from "@/shell/comments/moments";
import { toMetres, toPixels } from "@/map/plane/projection";
import type { On } from "../commands/command";
import type { OpenProgram } from "../state/context";

/** What a new thread is about; `label` is what this person calls it, empty for the program itself. */
export interface About {
  readonly anchor: ThreadToStart["anchor"];
  readonly label: string;
}

type Known = Pick<OpenProgram, "document" | "compiled" | "t">;
type Drawn = Pick<OpenProgram, "document" | "scene">;

const MOST_LABEL = 120;

/** The `t` of an open program begins within the texts of the editor. */
const say = (key: string, values?: Record<string, string | number>): string => i18next.t(key, values ?? {});

/** The number and kind of a step that the program has: `2 Pick-and-Drop`. */
export function stepLabel({ document, compiled, t }: Known, id: string): string | null {
  const step = document.steps[id];
  return step ? [compiled?.numbers[id], t(`kind.${step.kind}`)].filter(Boolean).join(" ") : null;
}

/** As the program calls it now; what is gone keeps the words with which the thread began. */
export function aboutOf(open: Known, { anchor, label }: Thread): string {
  if (anchor.kind === "construct" && anchor.root === "steps")
    return stepLabel(open, anchor.id ?? "") ?? (label || say("comments.program"));
  if (anchor.kind === "arrow") return arrowLabel(open, anchor.id ?? "", anchor.to ?? "") ?? label;
  const moment = momentOf({ anchor });
  if (moment) return momentWords(say, moment, label);
  return label || say(anchor.kind === "place" ? "comments.place" : "comments.program");
}

function arrowLabel(open: Known, from: string, to: string): string | null {
  const [one, other] = [stepLabel(open, from), stepLabel(open, to)];
  return one === null || other === null ? null : say("comments.arrow", { from: one, to: other });
}

/** Whether what a thread is about is still drawn; other things than steps as the server said when the list was read. */
export function standsNow({ document }: Pick<OpenProgram, "document">, { anchor, stands }: Thread): boolean {
  if (anchor.kind === "construct" && anchor.root === "steps") return (anchor.id ?? "") in document.steps;
  if (anchor.kind === "arrow") return [anchor.id, anchor.to].every((id) => (id ?? "") in document.steps);
  return stands;
}

/** The step that a thread is about, while it is drawn. */
export function stepOf({ document }: Pick<OpenProgram, "document">, { anchor }: Thread): string | null {
  const { kind, root, id } = anchor;
  return kind === "construct" && root === "steps" && id !== null && id in document.steps ? id : null;
}

/** Where a thread's pin stands, drawing pixels: at what it is about; where that was, once it is gone. */
export function placeOf(open: Drawn, thread: Thread): PixelPoint | null {
  const { anchor } = thread;
  if (standsNow(open, thread)) {
    const found = anchor.kind === "arrow" ? midOfArrow(open, anchor) : atStep(open, anchor.id ?? "");
    if (found) return found;
    if (anchor.kind !== "place") return null;
  }
  return anchor.x === null || anchor.y === null ? null : toPixels([anchor.x, anchor.y]);
}

/** A chip's upper left corner: its right one has marks of its own. */
function atStep({ scene }: Drawn, id: string): PixelPoint | null {
  const box = scene.chips.get(id)?.box;
  return box ? { x: box.left, y: box.top } : null;
}

function midOfArrow({ scene }: Drawn, { id, to }: { id: string | null; to: string | null }): PixelPoint | null {
  const points = scene.links.find((link) => link.from === id && link.to === to)?.points ?? [];
  return pointAlong(points, pathLength(points) / 2);
}

/** What a new thread would be about: the arrow, place or step of a menu, else the selected step, else the program. */
export function aboutFrom(open: OpenProgram, on: Pick<On, "steps" | "link" | "at">): About {
  const { link, at } = on;
  const from = link?.from ?? null;
  const to = link?.to ?? null;
  const label = from !== null && to !== null ? arrowLabel(open, from, to) : null;
  if (from !== null && to !== null && label !== null) {
    const mid = midOfArrow(open, { id: from, to });
    return { anchor: { kind: "arrow", id: from, to, ...(mid ? placed(mid) : {}) }, label: label.slice(0, MOST_LABEL) };
  }
  const [id] = on.steps;
  const step = on.steps.length === 1 && id !== undefined && !link ? stepLabel(open, id) : null;
  if (id !== undefined && step !== null) {
    const corner = atStep(open, id);
    return { anchor: { kind: "construct", root: "steps", id, ...(corner ? placed(corner) : {}) }, label: step };
  }
  if (at && on.steps.length === 0) {
    const label = say("comments.at", { x: formatNumber(at[0], 1), y: formatNumber(at[1], 1) });
    return { anchor: { kind: "place", x: at[0], y: at[1] }, label };
  }
  return { anchor: { kind: "program" }, label: "" };
}

function placed(at: PixelPoint): { x: number; y: number } {
  const [x, y] = toMetres(at);
  return { x, y };
}
