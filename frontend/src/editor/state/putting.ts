/** Steps from elsewhere put into the program: at once, or after a list has asked who stands in for unknown devices. */
import { create } from "zustand";
import type { ProgramDocument } from "@/program/document/document";
import type { Edit } from "../edits/edits";
import { type Chosen, strangersIn, type Stranger, withChosen } from "../edits/holes";
import type { OpenProgram } from "./context";
import { select, useUi } from "./ui";

/** Names that devices and places had where the steps come from, by id. */
export type Names = Readonly<Record<string, string>>;

interface Waiting {
  readonly strangers: readonly Stranger[];
  readonly put: (chosen: Chosen) => void;
}

/** What waits for the list of unknown devices. */
export const useWaiting = create<{ readonly waiting: Waiting | null }>(() => ({ waiting: null }));

/** Ask who stands in, if anybody is unknown; then put the steps in. */
export function putWith(strangers: readonly Stranger[], put: (chosen: Chosen) => void): void {
  if (strangers.length === 0) return put(new Map());
  useWaiting.setState({ waiting: { strangers, put } });
  return useUi.setState({ dialog: "strangers" });
}

/** One edit, and one entry to undo; made of the program as it is when it is put in. */
export function putEdits(
  { document, shared, devices, plan, apply }: OpenProgram,
  make: (document: ProgramDocument) => { readonly edits: readonly Edit[]; readonly added: readonly string[] },
  names: Names,
): void {
  const known = {
    devices: new Set(devices.map(({ id }) => id)),
    places: new Set((plan?.places ?? []).map(({ id }) => id)),
    names,
  };
  putWith(strangersIn(make(document).edits, known), (chosen) => {
    const { edits, added } = make(shared.getDocument());
    apply(withChosen(edits, chosen));
    select(added);
  });
}

/** The answer of the list; null where nothing is to be put in. */
export function answerWaiting(chosen: Chosen | null): void {
  const { waiting } = useWaiting.getState();
  useUi.setState({ dialog: null });
  useWaiting.setState({ waiting: null });
  if (chosen) waiting?.put(chosen);
}
