/** Modes in which the keyboard does what a pointer does by dragging: move in the order, connect, place on the map. */
import i18next from "i18next";
import { create } from "zustand";
import { chipLabel } from "@/program/scene/announcements";
import { branchesOf } from "@/program/document/tree";
import { branchWord } from "@/program/scene/links";
import type { Point } from "@/map/plane/projection";
import { toMetres } from "@/map/plane/projection";
import { knownBox } from "@/map/floor/floor";
import { formatNumber } from "@/i18n/format";
import { moveTogether } from "../edits/arranging";
import { decideJoin, joinByDot } from "../gestures/connection";
import { settle } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { freeSpot } from "../state/freeSpot";
import { createOnFloor } from "../state/newStep";
import { askOf } from "../state/tool";
import { select, useUi } from "../state/ui";
import { announce } from "./announcer";
import { type Bounds, byLetter, landmarksOf, nearest, stepped } from "./floor";
import { beside, decideMove, ownSpot, type Spot, spotsFor } from "./goals";

export type Mode =
  | { readonly kind: "move"; readonly steps: readonly string[]; readonly spots: readonly Spot[]; readonly at: number }
  | { readonly kind: "connect"; readonly from: string; readonly targets: readonly string[]; readonly at: number }
  | {
      readonly kind: "place";
      /** The steps that are put elsewhere; none where the tool in hand sets a new one down. */
      readonly steps: readonly string[];
      readonly from: Point;
      readonly at: Point;
      /** The landmark that was jumped to last. */
      readonly landmark: number;
    };

/** `words`: the same as is said, for who looks. */
export const useMode = create<{ readonly mode: Mode | null; readonly words: string }>(() => ({
  mode: null,
  words: "",
}));

function say(key: string, values: Record<string, unknown> = {}): string {
  return i18next.t(key, values);
}

function show(mode: Mode, words: string): void {
  useMode.setState({ mode, words });
  announce(words);
}

export function leaveMode(words?: string): void {
  useMode.setState({ mode: null, words: "" });
  if (words) announce(words);
}

/** Move the selected steps to another spot of the order. */
export function enterMove(open: OpenProgram): boolean {
  const steps = useUi.getState().selected.filter((id) => open.document.steps[id]?.kind !== "comment");
  return lookForSpots(open, steps, say("access.move.begin", { count: steps.length }));
}

/** The spots that the steps may go to now, from their own on; false where there is none. */
function lookForSpots(open: OpenProgram, steps: readonly string[], words: string): boolean {
  const spots = steps.length > 0 ? spotsFor(open.document, steps) : [];
  if (spots.length === 0) return false;
  const mode = { kind: "move" as const, steps, spots, at: ownSpot(open.document, steps, spots) };
  show(mode, `${words} ${moveWords(open, mode)}`);
  return true;
}

export function moveWords(open: OpenProgram, { spots, at }: Extract<Mode, { kind: "move" }>): string {
  const spot = spots[at];
  return spot ? spotWords(open, spot) : "";
}

/** "after 2, Operate", "inside If 3, branch true". */
export function spotWords(open: OpenProgram, { side, beside: id, branch }: Spot): string {
  const { document } = open;
  if (side === "first") return say("access.move.first", { name: document.functions[branch.parent]?.name ?? "" }).trim();
  const step = document.steps[id];
  if (side !== "inside" || !step) return say(`access.move.${side}`, { step: shortName(open, id) });
  const word = branch.branch === "body" ? "" : branchWord(branch.branch, step, open.t);
  return say(word ? "access.move.inside_branch" : "access.move.inside", { step: shortName(open, id), branch: word });
}

/** "2a Pick-and-Drop": enough to know it by. */
function shortName({ document, compiled, t }: OpenProgram, id: string): string {
  const kind = document.steps[id]?.kind ?? "";
  return `${compiled?.numbers[id] ?? ""} ${t(`kind.${kind}`)}`.trim();
}

/** Draw an arrow from the selected step to another one. */
export function enterConnect(open: OpenProgram): boolean {
  const [from, second] = useUi.getState().selected;
  if (from === undefined || second !== undefined || !open.document.steps[from]) return false;
  const { reading, loose } = open.scene.tree;
  const targets = [...reading, ...loose].filter((id) => id !== from && canJoin(open, from, id));
  if (targets.length === 0) return false;
  const mode = {
    kind: "connect" as const,
    from,
    targets,
    at: Math.max(
      0,
      targets.findIndex((id) => isBehind(open, from, id)),
    ),
  };
  show(mode, `${say("access.connect.begin", { step: shortName(open, from) })} ${connectWords(open, mode)}`);
  return true;
}

function isBehind({ scene }: OpenProgram, from: string, id: string): boolean {
  const { reading } = scene.tree;
  return reading.indexOf(id) > reading.indexOf(from);
}

function canJoin({ document }: OpenProgram, from: string, to: string): boolean {
  const decision = decideJoin(document, from, to);
  const step = document.steps[from];
  return (
    "edits" in decision ||
    (step !== undefined && branchesOf(step).length > 0 && document.steps[to]?.place?.[0] !== from)
  );
}

export function connectWords(open: OpenProgram, { targets, at }: Extract<Mode, { kind: "connect" }>): string {
  const chip = open.scene.chips.get(targets[at] ?? "");
  return say("access.connect.then", { step: chip ? chipLabel(chip, open.speaker) : "" });
}

/** Put the selected steps elsewhere on the map, or set the tool's step down where the keys lead. */
export function enterPlace(open: OpenProgram): boolean {
  const { gesture, selected } = useUi.getState();
  const ask = askOf(gesture);
  const draws = ask === "floor" || ask === "goal";
  const steps = draws ? [] : selected.filter((id) => open.document.steps[id]?.pos);
  const own = open.document.steps[steps[0] ?? ""]?.pos;
  if (!draws && !own) return false;
  const from: Point = own ? [own[0], own[1]] : freeSpot(open, gesture.tool);
  const mode = { kind: "place" as const, steps, from, at: from, landmark: -1 };
  show(mode, `${say("access.place.begin")} ${pointWords(open, from)}`);
  return true;
}

/** "4.0, −3.0: 1.2 m left of Item Inventory". */
export function pointWords(open: OpenProgram, at: Point): string {
  const near = nearest(at, landmarks(open));
  const point = { x: formatNumber(at[0], 1), y: formatNumber(at[1], 1) };
  if (!near) return say("access.place.point", point);
  const values = { ...point, name: near.name, metres: formatNumber(near.metres, 1) };
  return say(`access.place.${near.side}`, values);
}

function landmarks({ devices, plan }: OpenProgram) {
  return landmarksOf(devices, plan?.places ?? []);
}

function boundsOf({ plan }: OpenProgram): Bounds | null {
  if (!plan) return null;
  const box = knownBox(plan);
  const [left, top] = toMetres({ x: box.left, y: box.top });
  const [right, bottom] = toMetres({ x: box.right, y: box.bottom });
  return { left, right, top, bottom };
}

/** What a key does in a mode; false where it does nothing there. */
export function pressInMode(open: OpenProgram, mode: Mode, event: Pick<KeyboardEvent, "key" | "shiftKey">): boolean {
  if (event.key === "Escape") {
    leaveMode(say("access.left"));
    return true;
  }
  if (mode.kind === "move") return pressMove(open, mode, event.key);
  if (mode.kind === "connect") return pressConnect(open, mode, event.key);
  return pressPlace(open, mode, event);
}

const LISTED: Readonly<Record<string, number>> = {
  ArrowDown: 1,
  ArrowRight: 1,
  ArrowUp: -1,
  ArrowLeft: -1,
  Home: -Infinity,
  End: Infinity,
};

function pressMove(open: OpenProgram, mode: Extract<Mode, { kind: "move" }>, key: string): boolean {
  const by = LISTED[key];
  if (by !== undefined) {
    const next = { ...mode, at: beside(mode.at, by, mode.spots.length) };
    show(next, endWords(mode, next) + moveWords(open, next));
    return true;
  }
  const spot = mode.spots[mode.at];
  if (key !== "Enter" || !spot) return false;
  const where = spotWords(open, spot);
  const decision = decideMove(open.document, mode.steps, spot);
  const gone = "refused" in decision && decision.refused === "gone";
  if (gone && lookForSpots(open, mode.steps, open.t("refused.gone"))) return true;
  if (settle(open, decision)) leaveMode(say("access.move.done", { where }));
  return true;
}

/** At a hard end the list says so, and the same spot again. */
function endWords(before: { readonly at: number }, after: { readonly at: number }): string {
  return before.at === after.at ? `${say("access.end")} ` : "";
}

function pressConnect(open: OpenProgram, mode: Extract<Mode, { kind: "connect" }>, key: string): boolean {
  const by = LISTED[key];
  if (by !== undefined) {
    const next = { ...mode, at: beside(mode.at, by, mode.targets.length) };
    show(next, endWords(mode, next) + connectWords(open, next));
    return true;
  }
  const to = mode.targets[mode.at];
  if (key !== "Enter" || to === undefined) return false;
  const box = document.querySelector(`.react-flow__node[data-id="${CSS.escape(mode.from)}"]`)?.getBoundingClientRect();
  leaveMode(say("access.connect.done", { step: shortName(open, to) }));
  joinByDot(open, mode.from, to, { x: box?.left ?? innerWidth / 2, y: box?.bottom ?? innerHeight / 2 });
  return true;
}

function pressPlace(
  open: OpenProgram,
  mode: Extract<Mode, { kind: "place" }>,
  { key, shiftKey }: Pick<KeyboardEvent, "key" | "shiftKey">,
): boolean {
  const marks = landmarks(open);
  const at = stepped(mode.at, key, shiftKey, boundsOf(open));
  if (at) {
    show({ ...mode, at }, pointWords(open, at));
    return true;
  }
  const jump = key === "Tab" ? beside(mode.landmark, shiftKey ? -1 : 1, marks.length) : letterJump(marks, mode, key);
  const mark = jump === null ? undefined : marks[jump];
  if (mark && jump !== null) {
    show({ ...mode, at: mark.at, landmark: jump }, pointWords(open, mark.at));
    return true;
  }
  if (key !== "Enter") return key === "Tab";
  setDown(open, mode);
  leaveMode(say("access.place.done", { where: pointWords(open, mode.at) }));
  return true;
}

function letterJump(
  marks: ReturnType<typeof landmarks>,
  mode: Extract<Mode, { kind: "place" }>,
  key: string,
): number | null {
  return key.length === 1 && key !== " " ? byLetter(marks, mode.landmark, key) : null;
}

/** At the point: a new step of the tool in hand, or the steps that stood elsewhere, as far from each other as before. */
function setDown(open: OpenProgram, { steps, from, at }: Extract<Mode, { kind: "place" }>): void {
  if (steps.length === 0) {
    createOnFloor(open, useUi.getState().gesture, at);
    return;
  }
  open.apply(moveTogether(open, steps, [at[0] - from[0], at[1] - from[1]]));
  select(steps);
}
