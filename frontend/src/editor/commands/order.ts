/** Commands that change the order of steps and what holds them. */
import {
  ArrowDown,
  ArrowDownUp,
  ArrowLeftFromLine,
  ArrowRightToLine,
  ArrowUp,
  Braces,
  Link2,
  ListOrdered,
  Move,
  PackageOpen,
  Route,
  Spline,
  SquareFunction,
  Timer,
  Unlink,
} from "lucide-react";
import type { ProgramDocument } from "@/program/document/document";
import { expandCall } from "../edits/calls";
import type { Decision, Edit } from "../edits/edits";
import { liftOut, moveIn, swapBranches, takeApart } from "../edits/branches";
import { disconnect, joinDrafts, shiftStep } from "../edits/joints";
import { canLimit, limitSteps, makeId } from "../state/actions";
import { select, useUi } from "../state/ui";
import { enterConnect, enterMove, enterPlace } from "../keyboard/modes";
import { command, decided, needsRight, needsSteps, one, type Command } from "./command";

/** What came in place of something else is selected. */
function selectMoved(edits: readonly Edit[]): void {
  select(edits.flatMap((edit) => (edit.do === "set_place" || edit.do === "add_step" ? [edit.id] : [])));
}

function automatic(document: ProgramDocument, id: string): Decision {
  return document.steps[id]?.params.route
    ? { edits: [{ do: "set_param", id, name: "route", value: null }] }
    : { refused: "nothing" };
}

const ORDER = { group: "order", menus: ["step"] } as const;

export const ORDER_COMMANDS: readonly Command[] = [
  command({
    id: "move_up",
    ...ORDER,
    icon: ArrowUp,
    keys: ["Ctrl+ArrowUp"],
    ...decided(one((document, id) => shiftStep(document, id, -1))),
  }),
  command({
    id: "move_down",
    ...ORDER,
    icon: ArrowDown,
    keys: ["Ctrl+ArrowDown"],
    ...decided(one((document, id) => shiftStep(document, id, 1))),
  }),
  command({
    id: "move_mode",
    ...ORDER,
    icon: ListOrdered,
    keys: ["X"],
    when: "steps",
    whyNot: needsSteps,
    run: enterMove,
  }),
  command({
    id: "connect_mode",
    ...ORDER,
    icon: Spline,
    keys: ["D"],
    when: "steps",
    whyNot: needsSteps,
    run: enterConnect,
  }),
  command({ id: "place_mode", ...ORDER, icon: Move, keys: ["Q"], whyNot: needsRight, run: enterPlace }),
  command({ id: "lift_out", ...ORDER, icon: ArrowLeftFromLine, keys: ["Ctrl+Shift+ArrowLeft"], ...decided(liftOut) }),
  command({ id: "move_in", ...ORDER, icon: ArrowRightToLine, keys: ["Ctrl+Shift+ArrowRight"], ...decided(moveIn) }),
  command({ id: "swap_branches", ...ORDER, icon: ArrowDownUp, ...decided(one(swapBranches)) }),
  command({
    id: "limit",
    ...ORDER,
    icon: Timer,
    when: "steps",
    whyNot: (open, on) => needsSteps(open, on) ?? (canLimit(open, on.steps) ? null : "editor.refused.one_branch"),
    run: (open, on) => limitSteps(open, on.steps),
  }),
  command({
    id: "take_apart",
    ...ORDER,
    icon: PackageOpen,
    keys: ["Ctrl+Shift+Backspace"],
    ...decided(one(takeApart), selectMoved),
  }),
  command({
    id: "make_function",
    ...ORDER,
    icon: SquareFunction,
    keys: ["Ctrl+G"],
    when: "steps",
    whyNot: needsSteps,
    run: () => useUi.setState({ dialog: "function" }),
  }),
  command({
    id: "expand",
    ...ORDER,
    icon: Braces,
    keys: ["Ctrl+Shift+G"],
    ...decided(
      one((document, id) => expandCall(document, id, makeId)),
      selectMoved,
    ),
  }),
  command({ id: "join", ...ORDER, icon: Link2, ...decided(joinDrafts) }),
  command({ id: "disconnect", ...ORDER, icon: Unlink, ...decided(disconnect) }),
  command({ id: "automatic", ...ORDER, icon: Route, ...decided(one(automatic)) }),
];
