/** Visits to fields: what is stored during one is one entry of the undo list, however often its field stores. */
import type * as Y from "yjs";
import type { Edit } from "../edits/edits";
import { editsOf, keepEdits } from "./undoList";

/** One visit; known by being itself. */
export type FieldVisit = object;

/** Under this name an entry of the undo list keeps the visit that made it. */
const VISIT = "visit";

export class FieldVisits {
  #now: FieldVisit | null = null;

  constructor(private readonly undo: Y.UndoManager) {}

  /** The visit that lasts; null while no field has the keyboard. */
  get now(): FieldVisit | null {
    return this.#now;
  }

  begin(): void {
    this.#now = {};
  }

  end(): void {
    this.#now = null;
  }

  /** Store what was written in a visit that may be over: what a line means, the server says later. */
  during(visit: FieldVisit | null, store: () => void): void {
    const now = this.#now;
    this.#now = visit;
    try {
      store();
    } finally {
      this.#now = now;
    }
  }

  /**
   * Change the document by edits: as part of the visit's entry, as long as nothing else has become one since, else as an
   * entry of its own.
   */
  capture(edits: readonly Edit[], change: () => void): void {
    const { undo } = this;
    const { length } = undo.undoStack;
    const joins = this.#now !== null && undo.undoStack.at(-1)?.meta.get(VISIT) === this.#now;
    undo.captureTimeout = joins ? Infinity : 0;
    undo.lastChange = joins ? Date.now() : 0;
    change();
    undo.captureTimeout = 0;
    undo.stopCapturing();
    const entry = undo.undoStack.at(-1);
    if (!entry || (!joins && undo.undoStack.length === length)) return; // nothing has changed
    keepEdits(entry, joins ? [...editsOf(entry), ...edits] : edits);
    entry.meta.set(VISIT, this.#now);
  }
}
