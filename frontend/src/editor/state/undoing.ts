/** Undo and redo, which ask before they overwrite what somebody else has set since, or remove it with its step. */
import type { ProgramDocument } from "@/program/document/document";
import { changedSince, workedOnSince } from "../edits/undo";
import { editsOf, type Entry, type Way } from "../shared/undoList";
import type { OpenProgram } from "./context";
import { type Offer, say, useUi } from "./ui";

type Open = Pick<OpenProgram, "shared" | "t">;

/** Undo or redo what comes next; entries of which nothing is left are passed over. */
export function goBack(open: Open, way: Way): void {
  while (open.shared.undo.next(way)) if (settle(open, way)) return;
}

/** Undo what was done since there were so many entries, for as long as that overwrites nothing of others. */
export function undoDownTo(open: Open, length: number): void {
  const { undo } = open.shared;
  while (undo.length > length) if (settle(open, "undo") === "asked") return;
}

/**
 * Do a gesture and say what it did; for as long as it is the last, it can be undone there. Nothing is said of one that
 * changed nothing, or that is part of an older entry: its Undo would take back something else.
 */
export function doAndSay<Done>(
  { shared }: Pick<OpenProgram, "shared">,
  act: () => Done,
  text: (done: Done) => string,
): void {
  const before = shared.undo.next("undo");
  const done = act();
  const entry = shared.undo.next("undo");
  if (entry && entry !== before) say(text(done), { way: "undo", entry, asked: false });
}

/** What a toast offers is done once; nothing happens where something else would be undone or redone by now. */
export function takeOffer(open: Open, { way, entry, asked }: Offer): void {
  useUi.setState({ toast: null });
  if (open.shared.undo.next(way) === entry) settle(open, way, asked);
}

/** What others would lose by it. */
function lossOf(document: ProgramDocument, entry: Entry, way: Way) {
  const edits = editsOf(entry);
  if (workedOnSince(document, edits)) return "worked_on";
  return changedSince(document, edits) ? (way === "undo" ? "overwritten" : "overwritten_redo") : null;
}

/** The next entry: done, or asked about; null where nothing of it was left. */
function settle({ shared, t }: Open, way: Way, asked = false): "done" | "asked" | null {
  const entry = shared.undo.next(way);
  if (!entry) return null;
  const why = asked ? null : lossOf(shared.getDocument(), entry, way);
  if (why) {
    say(t(`gesture.${why}`), { way, entry, asked: true });
    return "asked";
  }
  return shared.undo.carryOut(way) ? "done" : null;
}
