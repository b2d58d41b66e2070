/** What this person did, to be undone and done again: one entry at a time, with what it set in the program. */
import type * as Y from "yjs";
import { EMPTY_DOCUMENT } from "@/program/document/document";
import type { Edit } from "../edits/edits";
import { asTheyAre } from "../edits/undo";
import { rereadDocument, ROOTS } from "./snapshot";

/** One gesture, or one visit to a field, that can be undone or redone; known by being itself. */
export type Entry = Y.UndoManager["undoStack"][number];
export type Way = "undo" | "redo";

/** Under this name an entry keeps its edits. */
const EDITS = "edits";

/** What the gesture, the visit, or undoing or redoing it set. */
export function editsOf(entry: Entry): readonly Edit[] {
  return (entry.meta.get(EDITS) as readonly Edit[] | undefined) ?? [];
}

export function keepEdits(entry: Entry, edits: readonly Edit[]): void {
  entry.meta.set(EDITS, edits);
}

function sets(own: Edit, edit: Edit): boolean {
  return "id" in own && "id" in edit && own.id === edit.id && (own.do === "add_step" || own.do === edit.do);
}

const CHANGES = ["stack-item-added", "stack-item-popped", "stack-cleared"] as const;

export class UndoList {
  readonly #listeners = new Set<() => void>();
  #busy = false;

  constructor(private readonly manager: Y.UndoManager) {
    manager.on("stack-item-added", ({ stackItem }) => this.#handOn(stackItem));
    for (const change of CHANGES) manager.on(change, () => this.#tell());
  }

  /** How many entries can be undone. */
  get length(): number {
    return this.manager.undoStack.length;
  }

  /** What would be undone or redone next; null where there is nothing. */
  next(way: Way): Entry | null {
    return this.#stack(way).at(-1) ?? null;
  }

  /** Undo or redo the next entry and no other: false where nothing of it is left, and the list has it no more. */
  carryOut(way: Way): boolean {
    // Yjs goes on to older entries until one does something: it is shown none.
    const older = this.#stack(way).splice(0, this.#stack(way).length - 1);
    this.#busy = true;
    try {
      return this.manager[way]() !== null;
    } finally {
      this.#stack(way).unshift(...older);
      this.#busy = false;
      this.#tell();
    }
  }

  /** Take what the program put right into the last entry that set it: nobody else has changed it. */
  adjusted(edits: readonly Edit[]): void {
    for (const edit of edits) {
      const entry = this.manager.undoStack.findLast((each) => editsOf(each).some((own) => sets(own, edit)));
      if (entry) keepEdits(entry, [...editsOf(entry), edit]);
    }
  }

  /** Hear when something else would be undone or redone next. */
  readonly subscribe = (listener: () => void): (() => void) => {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  };

  #stack(way: Way): Entry[] {
    return way === "undo" ? this.manager.undoStack : this.manager.redoStack;
  }

  /** What undoing an entry has set is what redoing would overwrite, and the other way round. */
  #handOn(entry: Entry): void {
    const { currStackItem: from, doc } = this.manager;
    if (!from) return; // a gesture, which keeps its own
    const edits = editsOf(from);
    const ids = new Set(edits.flatMap((edit) => ("id" in edit ? [edit.id] : [])));
    const now = rereadDocument(doc, EMPTY_DOCUMENT, new Map(ROOTS.map((root) => [root, ids])));
    keepEdits(entry, asTheyAre(now, edits));
  }

  #tell(): void {
    if (!this.#busy) for (const listener of this.#listeners) listener();
  }
}
