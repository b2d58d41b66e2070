/** One record per gesture that changes the order: feeds the step's menu and the keys. */
import { expandCall } from "../edits/calls";
import type { Decision, Edit } from "../edits/edits";
import { liftOut, moveIn, swapBranches, takeApart } from "../edits/branches";
import { disconnect, joinDrafts, shiftStep } from "../edits/joints";
import { outermost } from "@/program/document/tree";
import type { ProgramDocument } from "@/program/document/document";
import { canLimit, duplicateSelected, limitSteps, makeId, removeSelected, settle } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { say, select, useUi } from "../state/ui";
import { enterConnect, enterMove, enterPlace } from "../keyboard/modes";
import { copyToSystem } from "./clipboard";

export interface Command {
  /** `gestures.command.<id>` in the catalogues. */
  readonly id: string;
  /** As in "Ctrl+Shift+G"; empty where only the menu has it. */
  readonly keys: string;
  readonly applies: (open: OpenProgram, selected: readonly string[]) => boolean;
  readonly run: (open: OpenProgram, selected: readonly string[]) => void;
}

type Decide = (document: ProgramDocument, selected: readonly string[]) => Decision;

const NOTHING: Decision = { refused: "nothing" };

/** A command that is offered when its decision changes something. */
function decided(id: string, keys: string, decide: Decide, after?: (edits: readonly Edit[]) => void): Command {
  return {
    id,
    keys,
    applies: ({ document, canEdit }, selected) => canEdit && "edits" in decide(document, selected),
    run: (open, selected) => {
      const decision = decide(open.document, selected);
      if (settle(open, decision) && "edits" in decision) after?.(decision.edits);
    },
  };
}

/** A decision about one step. */
function one(decide: (document: ProgramDocument, id: string) => Decision): Decide {
  return (document, selected) => {
    const [only, second] = outermost(document, selected);
    return only !== undefined && second === undefined ? decide(document, only) : NOTHING;
  };
}

function acting(id: string, keys: string, run: Command["run"], applies = hasSteps): Command {
  return { id, keys, applies, run };
}

/** A mode of the keyboard; it says by itself where it does not apply. */
function mode(id: string, keys: string, enter: (open: OpenProgram) => boolean): Command {
  return acting(id, keys, (open) => void enter(open));
}

function hasSteps({ canEdit }: OpenProgram, selected: readonly string[]): boolean {
  return canEdit && selected.length > 0;
}

function automatic(document: ProgramDocument, id: string): Decision {
  return document.steps[id]?.params.route
    ? { edits: [{ do: "set_param", id, name: "route", value: null }] }
    : { refused: "nothing" };
}

/** What came in place of something else is selected. */
function selectMoved(edits: readonly Edit[]): void {
  select(edits.flatMap((edit) => (edit.do === "set_place" || edit.do === "add_step" ? [edit.id] : [])));
}

export const COMMANDS: readonly Command[] = [
  decided(
    "move_up",
    "Ctrl+ArrowUp",
    one((document, id) => shiftStep(document, id, -1)),
  ),
  decided(
    "move_down",
    "Ctrl+ArrowDown",
    one((document, id) => shiftStep(document, id, 1)),
  ),
  mode("move_mode", "X", enterMove),
  mode("connect_mode", "D", enterConnect),
  mode("place_mode", "Q", enterPlace),
  decided("lift_out", "Ctrl+Shift+ArrowLeft", liftOut),
  decided("move_in", "Ctrl+Shift+ArrowRight", moveIn),
  decided("swap_branches", "", one(swapBranches)),
  { id: "limit", keys: "", applies: canLimit, run: limitSteps },
  decided("take_apart", "Ctrl+Shift+Backspace", one(takeApart), selectMoved),
  acting("make_function", "Ctrl+G", () => useUi.setState({ dialog: "function" })),
  decided(
    "expand",
    "Ctrl+Shift+G",
    one((document, id) => expandCall(document, id, makeId)),
    selectMoved,
  ),
  decided("join", "", joinDrafts),
  decided("disconnect", "", disconnect),
  decided("automatic", "", one(automatic)),
  acting(
    "copy",
    "Ctrl+C",
    (open) => copyToSystem(open, false),
    (_open, selected) => selected.length > 0,
  ),
  acting("cut", "Ctrl+X", (open) => copyToSystem(open, true)),
  acting("duplicate", "Ctrl+D", ({ document, apply }) => duplicateSelected(document, apply)),
  acting("delete", "Delete", ({ document, apply, t }) => {
    const count = removeSelected(document, apply);
    if (count > 0) say(t("removed", { count }), true);
  }),
];
