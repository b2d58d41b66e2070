/** The program that several people edit: Yjs, its server, its copy in the browser, undo and presence. */
import { IndexeddbPersistence } from "y-indexeddb";
import { WebsocketProvider } from "y-websocket";
import * as Y from "yjs";
import * as buffer from "lib0/buffer";
import { api } from "@/api/client";
import type { Edit } from "../edits/edits";
import { SavedChanges } from "./savedChanges";
import { CompiledForm } from "./compiledForm";
import { writeEdit } from "./writer";
import { changedBy, readDocument, rereadDocument, ROOTS } from "./snapshot";
import type { ProgramDocument } from "@/program/document/document";

/** Under this name an entry of the undo list keeps its edits. */
const EDITS = "edits";

export type Connection = "connecting" | "live" | "reconnecting" | "refused";

export interface Saving {
  readonly connection: Connection;
  /** How many of our own edits the server has not yet called saved. */
  readonly waiting: number;
  /** How many messages with edits of ours it did not take, since we may only look. */
  readonly notTaken: number;
  /** Everything is here: from the server, or from the browser's copy. */
  readonly loaded: boolean;
  readonly closedWith: number | null;
}

/** Of the steps that somebody removes at once, so many are named to the others. */
const MOST_REMOVED = 40;

type Listener = () => void;

/** One open program. Call `close` when its screen goes. */
export class SharedProgram {
  readonly doc = new Y.Doc();
  readonly undo: Y.UndoManager;
  readonly provider: WebsocketProvider;
  #provider: WebsocketProvider | null = null;
  readonly compiled: CompiledForm;
  readonly #copy: IndexeddbPersistence;
  readonly #saved = new SavedChanges(() => this.#showSaved());
  readonly #origin = Symbol("this person");
  readonly #listeners = new Set<Listener>();
  readonly #savingListeners = new Set<Listener>();
  #document: ProgramDocument;
  #saving: Saving = { connection: "connecting", waiting: 0, notTaken: 0, loaded: false, closedWith: null };
  #changed = new Map<string, Set<string>>();

  constructor(
    private readonly program: string,
    serverUrl: string,
  ) {
    this.#document = readDocument(this.doc);
    const roots = ROOTS.map((name) => this.doc.getMap(name));
    this.undo = new Y.UndoManager(roots, {
      trackedOrigins: new Set([this.#origin]),
      captureTimeout: 0,
      ignoreRemoteMapChanges: true,
    });
    ROOTS.forEach((name, index) => roots[index]?.observeDeep((events) => this.#note(name, events)));
    this.doc.on("afterTransaction", () => this.#publish());
    this.doc.on("update", (_update, origin) => {
      if (origin !== this.#copy && origin !== this.#provider) this.#saved.made(); // before it is sent
    });
    this.#copy = new IndexeddbPersistence(`vipo-program-${program}`, this.doc);
    this.#copy.on("synced", () => this.#setSaving({ loaded: this.#saving.loaded || this.doc.store.clients.size > 0 }));
    // Tabs do not hand edits to each other: each one's own are sent, counted and called saved by itself.
    this.provider = new WebsocketProvider(serverUrl, program, this.doc, {
      disableBc: true,
      WebSocketPolyfill: this.#saved.Socket,
    });
    this.#provider = this.provider;
    this.#saved.listen(this.provider.messageHandlers);
    this.compiled = new CompiledForm(this.provider);
    this.#listenToServer();
  }

  /** Hear which steps others remove, while the document is still the one before; one's own are named to the others. */
  onRemoval(listener: (gone: readonly string[]) => void): () => void {
    const steps = this.doc.getMap("steps");
    const note = (event: Y.YMapEvent<unknown>) => {
      const gone = [...event.changes.keys].filter(([, change]) => change.action === "delete").map(([id]) => id);
      if (gone.length === 0) return;
      if (event.transaction.local) this.awareness.setLocalStateField("removed", gone.slice(0, MOST_REMOVED));
      else listener(gone);
    };
    steps.observe(note);
    return () => steps.unobserve(note);
  }

  get awareness(): WebsocketProvider["awareness"] {
    return this.provider.awareness;
  }

  readonly getDocument = (): ProgramDocument => this.#document;
  readonly getSaving = (): Saving => this.#saving;

  readonly subscribe = (listener: Listener): (() => void) => {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  };

  readonly subscribeSaving = (listener: Listener): (() => void) => {
    this.#savingListeners.add(listener);
    return () => this.#savingListeners.delete(listener);
  };

  /** One gesture: one transaction, one entry in the undo list. */
  apply(edits: readonly Edit[]): void {
    if (edits.length === 0) return;
    this.undo.stopCapturing();
    applyEditsToDoc(this.doc, edits, this.#origin);
    this.undo.stopCapturing();
    this.undo.undoStack.at(-1)?.meta.set(EDITS, edits);
  }

  /** What the program itself puts right after a gesture: no entry of its own in the undo list. */
  adjust(edits: readonly Edit[]): void {
    applyEditsToDoc(this.doc, edits);
  }

  /** What the gesture set that would be undone next. */
  lastEdits(): readonly Edit[] {
    return (this.undo.undoStack.at(-1)?.meta.get(EDITS) as readonly Edit[] | undefined) ?? [];
  }

  /** Wait until the database holds what is on this screen, also of others: before something is made of the program. */
  async stored(): Promise<void> {
    const seen = Y.encodeSnapshot(Y.snapshot(this.doc));
    await api.post(`/programs/${this.program}/stored`, { seen: buffer.toBase64(seen) });
  }

  close(): void {
    this.provider.destroy();
    this.undo.destroy();
    void this.#copy.destroy();
    this.doc.destroy();
  }

  #note(root: string, events: readonly Y.YEvent<Y.AbstractType<unknown>>[]): void {
    const ids = this.#changed.get(root) ?? new Set();
    for (const id of changedBy(root, events)) ids.add(id);
    this.#changed.set(root, ids);
  }

  #publish(): void {
    if (this.#changed.size === 0) return;
    this.#document = rereadDocument(this.doc, this.#document, this.#changed);
    this.#changed = new Map();
    for (const listener of this.#listeners) listener();
  }

  #showSaved(): void {
    const { waiting, refused } = this.#saved;
    if (waiting !== this.#saving.waiting || refused !== this.#saving.notTaken)
      this.#setSaving({ waiting, notTaken: refused });
  }

  #listenToServer(): void {
    const { provider } = this;
    provider.on("status", ({ status }) => {
      if (status === "connected") this.#setSaving({ connection: "live" });
      if (status === "disconnected" && this.#saving.connection !== "refused")
        this.#setSaving({ connection: "reconnecting" });
    });
    provider.on("sync", (synced) => {
      if (synced) this.#setSaving({ loaded: true });
    });
    provider.on("connection-close", (event) => {
      if (event && event.code >= 4400 && event.code < 4500)
        this.#setSaving({ connection: "refused", closedWith: event.code });
    });
  }

  #setSaving(change: Partial<Saving>): void {
    this.#saving = { ...this.#saving, ...change };
    for (const listener of this.#savingListeners) listener();
  }
}

/** Apply edits as one transaction. */
export function applyEditsToDoc(doc: Y.Doc, edits: readonly Edit[], origin: unknown = null): void {
  doc.transact(() => {
    for (const edit of edits) writeEdit(doc, edit);
  }, origin);
}
