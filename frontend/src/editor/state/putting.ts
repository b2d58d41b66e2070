/** Steps from elsewhere put into the program: at once, or after a list has asked who stands in for unknown devices. */
import { create } from "zustand";
import type { Edit } from "../edits/edits";
import { type Chosen, strangersIn, type Stranger, withChosen } from "../edits/holes";
import type { OpenProgram } from "./context";
import { select, useUi } from "./ui";

/** Names that devices and places had where the steps come from, by id. */
export type Names = Readonly<Record<string, string>>;
export const NOTHING_KNOWN: Names = {};

interface Waiting {
  readonly edits: readonly Edit[];
  /** The steps to select. */
  readonly added: readonly string[];
  readonly strangers: readonly Stranger[];
}

/** What waits for the list of unknown devices. */
export const useWaiting = create<{ readonly waiting: Waiting | null }>(() => ({ waiting: null }));

/** One edit, and one entry to undo. */
export function putEdits(
  { devices, plan, apply }: Pick<OpenProgram, "devices" | "plan" | "apply">,
  edits: readonly Edit[],
  added: readonly string[],
  names: Names,
): void {
  const known = {
    devices: new Set(devices.map(({ id }) => id)),
    places: new Set((plan?.places ?? []).map(({ id }) => id)),
    names,
  };
  const strangers = strangersIn(edits, known);
  if (strangers.length === 0) {
    apply(edits);
    select(added);
    return;
  }
  useWaiting.setState({ waiting: { edits, added, strangers } });
  useUi.setState({ dialog: "strangers" });
}

/** The answer of the list. */
export function putWaiting({ apply }: Pick<OpenProgram, "apply">, chosen: Chosen): void {
  const { waiting } = useWaiting.getState();
  if (!waiting) return;
  apply(withChosen(waiting.edits, chosen));
  select(waiting.added);
  useWaiting.setState({ waiting: null });
}
