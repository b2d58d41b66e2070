/** One record for each command: toolbar, menus, keys, palette, help sheet and tests are made from these. */
import i18next from "i18next";
import { createElement, type ComponentType } from "react";
import { VipoIcon } from "@/design/VipoIcon";
import type { Point } from "@/map/plane/projection";
import { outermost } from "@/program/document/tree";
import type { ProgramDocument } from "@/program/document/document";
import type { Link } from "@/program/scene/links";
import type { Decision, Edit } from "../edits/edits";
import { settle } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { useGestures } from "../state/gestures";
import { ZONE_TOOL } from "../state/tools";
import { say, useUi } from "../state/ui";

/** What a command is about: what was pressed for a menu, else what is selected. */
export interface On {
  readonly steps: readonly string[];
  readonly zone: string | null;
  readonly device: string | null;
  readonly link: Link | null;
  /** Metres; where a menu was opened. */
  readonly at: Point | null;
  /** The keys that were pressed, as `nameOfKeys` has them. */
  readonly keys?: string;
  /** What had the keyboard. */
  readonly target?: EventTarget | null;
}

/** In the order of this list the help sheet has them. */
export const GROUPS = ["draw", "edit", "order", "arrange", "view", "go", "program"] as const;
export type Group = (typeof GROUPS)[number];

/** The narrowest that holds has the key: Enter closes a zone that is being drawn, and else edits the selected step. */
export const SITUATIONS = ["drawing_zone", "zone", "steps", "map"] as const;
export type Situation = (typeof SITUATIONS)[number];

export type MenuOf = "floor" | "step" | "arrow" | "machine";

export interface Command {
  readonly id: string;
  readonly group: Group;
  /** Where its words stand in the catalogues: its name, a sentence about it, and other words to find it by. */
  readonly words: { readonly name: string; readonly about?: string; readonly also?: string };
  readonly icon: ComponentType<{ size?: number }>;
  /** As `nameOfKeys` writes them; people may choose others, but for fixed ones. */
  readonly keys: readonly string[];
  readonly fixed?: boolean;
  /** Its keys are heard through the browser's own event: copy, cut and paste. */
  readonly byBrowser?: boolean;
  readonly when: Situation;
  /** The menus that have it. */
  readonly menus?: readonly MenuOf[];
  /** Means nothing without its key: a direction, or one step back. */
  readonly onlyKeys?: boolean;
  /** Why it cannot be done now, as a key of the catalogues; null where it can. */
  readonly whyNot: (open: OpenProgram, on: On) => string | null;
  /** False where it does nothing, and the key is somebody else's. */
  readonly run: (open: OpenProgram, on: On) => unknown;
}

export type WhyNot = Command["whyNot"];

/** Parts that most commands have alike. */
type Wanted = Pick<Command, "id" | "group" | "icon" | "run"> & Partial<Command>;

export function command(wanted: Wanted): Command {
  const words = { name: `commands.${wanted.id}.name`, also: `commands.${wanted.id}.also` };
  return { keys: [], when: "map", whyNot: () => null, words, ...wanted };
}

/** What is selected now. */
export function selection(): On {
  return { steps: useUi.getState().selected, zone: useGestures.getState().zone, device: null, link: null, at: null };
}

/** What a button, a menu or the palette does. */
export function runCommand(open: OpenProgram, command: Command, on = selection()): void {
  const reason = command.whyNot(open, on);
  if (reason === null) command.run(open, on);
  else say(i18next.t(reason));
}

export function holds(situation: Situation): boolean {
  const { gesture, selected } = useUi.getState();
  switch (situation) {
    case "drawing_zone":
      return gesture.tool === ZONE_TOOL;
    case "zone":
      return useGestures.getState().zone !== null && selected.length === 0;
    case "steps":
      return selected.length > 0;
    case "map":
      return true;
  }
}

export const needsRight: WhyNot = ({ canEdit }) => (canEdit ? null : "commands.why.look_only");

export const needsSteps: WhyNot = (open, { steps }) =>
  needsRight(open, selection()) ?? (steps.length > 0 ? null : "commands.why.no_steps");

type Decide = (document: ProgramDocument, selected: readonly string[]) => Decision;

/** A decision about one step. */
export function one(decide: (document: ProgramDocument, id: string) => Decision): Decide {
  return (document, selected) => {
    const [only, second] = outermost(document, selected);
    return only !== undefined && second === undefined ? decide(document, only) : { refused: "nothing" };
  };
}

/** A command about steps that can be done where its decision changes something. */
export function decided(
  decide: Decide,
  after?: (edits: readonly Edit[]) => void,
): Pick<Command, "when" | "whyNot" | "run"> {
  return {
    when: "steps",
    whyNot: (open, on) => {
      const missing = needsSteps(open, on);
      if (missing) return missing;
      const decision = decide(open.document, on.steps);
      return "refused" in decision ? `editor.refused.${decision.refused}` : null;
    },
    run: (open, on) => {
      const decision = decide(open.document, on.steps);
      if (settle(open, decision) && "edits" in decision) after?.(decision.edits);
    },
  };
}

/** One of VIPO's own icons as a component. */
export function vipoIcon(name: string): Command["icon"] {
  return ({ size = 18 }) => createElement(VipoIcon, { name, size });
}
