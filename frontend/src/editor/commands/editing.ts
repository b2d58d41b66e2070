/** Commands that take steps away, bring them back, copy and shift them. */
import { ClipboardPaste, Copy, CopyPlus, Move, Redo2, Scissors, Trash2, Undo2 } from "lucide-react";
import type { Position } from "@/program/document/document";
import { copyToSystem, hasCopied, pasteCopied } from "../gestures/clipboard";
import { duplicateSelected, nudgeSelected, removeSelected } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { useGestures } from "../state/gestures";
import { doAndSay, goBack } from "../state/undoing";
import { removeZone } from "../zones/zoneTool";
import { command, needsRight, needsSteps, type Command, type On } from "./command";

/** Metres for one press. */
const NUDGE_M = 0.1;
const FAR_NUDGE_M = 0.5;
const DIRECTIONS: Readonly<Record<string, Position>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
const ARROWS = Object.keys(DIRECTIONS);

/** Which way the last part of the pressed keys points. */
export function directionOf(keys: string | undefined): Position {
  return DIRECTIONS[keys?.split("+").at(-1) ?? ""] ?? [0, 0];
}

function nudge(open: OpenProgram, { keys }: On, metres: number): void {
  const [dx, dy] = directionOf(keys);
  nudgeSelected(open, [dx * metres, dy * metres]);
}

function remove(open: OpenProgram): void {
  doAndSay(
    open,
    () => removeSelected(open.document, open.apply),
    (count) => open.t("removed", { count }),
  );
}

const EDIT = { group: "edit" } as const;
const STEPS = { group: "edit", when: "steps", menus: ["step"] } as const;

export const EDIT_COMMANDS: readonly Command[] = [
  command({
    id: "undo",
    ...EDIT,
    icon: Undo2,
    keys: ["Ctrl+Z"],
    menus: ["floor"],
    whyNot: (open, on) =>
      needsRight(open, on) ?? (open.shared.undo.next("undo") ? null : "commands.why.nothing_to_undo"),
    run: (open) => goBack(open, "undo"),
  }),
  command({
    id: "redo",
    ...EDIT,
    icon: Redo2,
    keys: ["Ctrl+Shift+Z", "Ctrl+Y"],
    menus: ["floor"],
    whyNot: (open, on) =>
      needsRight(open, on) ?? (open.shared.undo.next("redo") ? null : "commands.why.nothing_to_redo"),
    run: (open) => goBack(open, "redo"),
  }),
  command({
    id: "copy",
    ...STEPS,
    icon: Copy,
    keys: ["Ctrl+C"],
    fixed: true,
    byBrowser: true,
    whyNot: (_open, { steps }) => (steps.length > 0 ? null : "commands.why.no_steps"),
    run: (open) => copyToSystem(open, false),
  }),
  command({
    id: "cut",
    ...STEPS,
    icon: Scissors,
    keys: ["Ctrl+X"],
    fixed: true,
    byBrowser: true,
    whyNot: needsSteps,
    run: (open) => copyToSystem(open, true),
  }),
  command({
    id: "paste",
    ...EDIT,
    icon: ClipboardPaste,
    keys: ["Ctrl+V"],
    fixed: true,
    byBrowser: true,
    menus: ["floor"],
    whyNot: (open, on) => needsRight(open, on) ?? (hasCopied() ? null : "commands.why.nothing_copied"),
    run: pasteCopied,
  }),
  command({
    id: "duplicate",
    ...STEPS,
    icon: CopyPlus,
    keys: ["Ctrl+D"],
    whyNot: needsSteps,
    run: ({ document, apply }) => duplicateSelected(document, apply),
  }),
  command({ id: "delete", ...STEPS, icon: Trash2, keys: ["Delete", "Backspace"], whyNot: needsSteps, run: remove }),
  command({
    id: "nudge",
    ...EDIT,
    when: "steps",
    icon: Move,
    keys: ARROWS.map((arrow) => `Alt+${arrow}`),
    fixed: true,
    onlyKeys: true,
    whyNot: needsSteps,
    run: (open, on) => nudge(open, on, NUDGE_M),
  }),
  command({
    id: "nudge_far",
    ...EDIT,
    when: "steps",
    icon: Move,
    keys: ARROWS.map((arrow) => `Alt+Shift+${arrow}`),
    fixed: true,
    onlyKeys: true,
    whyNot: needsSteps,
    run: (open, on) => nudge(open, on, FAR_NUDGE_M),
  }),
  command({
    id: "delete_zone",
    ...EDIT,
    icon: Trash2,
    when: "zone",
    keys: ["Delete", "Backspace"],
    whyNot: (open, on) => needsRight(open, on) ?? (on.zone ? null : "commands.why.no_zone"),
    run: (open) => {
      const { zone } = useGestures.getState();
      if (zone !== null) removeZone(open, zone);
    },
  }),
];
