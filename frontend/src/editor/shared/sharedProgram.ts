/** The program that several people edit: Yjs, its server, its copy in the browser, undo and presence. */
import { WebsocketProvider } from "y-websocket";
import * as Y from "yjs";
import * as buffer from "lib0/buffer";
import { api } from "@/api/client";
import type { Edit } from "../edits/edits";
import { FieldVisits } from "./fieldVisits";
import { SavedChanges } from "./savedChanges";
import { CompiledForm } from "./compiledForm";
import { LocalCopy, TAKEN_OVER, type Waiting } from "./localCopy";
import { UndoList } from "./undoList";
import { writeEdit } from "./writer";
import { changedBy, readDocument, rereadDocument, rereadSteps, ROOTS } from "./snapshot";
import type { ProgramDocument } from "@/program/document/document";

export type Connection = "connecting" | "live" | "reconnecting" | "refused";

export interface Saving {
  readonly connection: Connection;
  /** How many of our own edits the server has not yet called saved. */
  readonly waiting: number;
  /** All of them are in this browser's copy: a page that is opened anew has them. */
  readonly kept: boolean;
  /** Something of it has waited for longer than a moment. */
  readonly late: boolean;
  /** How many messages with edits of ours it did not take, since we may only look. */
  readonly notTaken: number;
  /** Everything is here: from the server, or from the browser's copy. */
  readonly loaded: boolean;
  readonly closedWith: number | null;
}

/** A browser that gives nothing back within this time is worked in without a copy until it comes. */
const PATIENCE_MS = 3000;

/** Of the steps that somebody removes at once, so many are named to the others. */
const MOST_REMOVED = 40;

type Listener = () => void;

const START: Saving = {
  connection: "connecting",
  waiting: 0,
  kept: true,
  late: false,
  notTaken: 0,
  loaded: false,
  closedWith: null,
};

/** One open program. Call `close` when its screen goes. */
export class SharedProgram {
  readonly doc = new Y.Doc();
  readonly undo: UndoList;
  readonly visits: FieldVisits;
  readonly provider: WebsocketProvider;
  #provider: WebsocketProvider | null = null;
  readonly compiled: CompiledForm;
  readonly #copy: LocalCopy;
  readonly #saved = new SavedChanges(() => this.#showSaved());
  /** Steps that edits changed, of pages before, too, which the server has not yet called saved. */
  readonly #unsaved = new Set<string>();
  #earlier = 0;
  #keepings = 0;
  #closed = false;
  readonly #origin = Symbol("this person");
  readonly #listeners = new Set<Listener>();
  readonly #savingListeners = new Set<Listener>();
  readonly #nothing: ProgramDocument;
  #document: ProgramDocument;
  #saving: Saving = START;
  #changed = new Map<string, Set<string>>();

  constructor(
    private readonly program: string,
    serverUrl: string,
    person: string,
  ) {
    this.#nothing = this.#document = readDocument(this.doc);
    const roots = ROOTS.map((name) => this.doc.getMap(name));
    const manager = new Y.UndoManager(roots, {
      trackedOrigins: new Set([this.#origin]),
      captureTimeout: 0,
      ignoreRemoteMapChanges: true,
    });
    this.undo = new UndoList(manager);
    this.visits = new FieldVisits(manager);
    ROOTS.forEach((name, index) => roots[index]?.observeDeep((events) => this.#note(name, events)));
    this.doc.on("afterTransaction", () => this.#publish());
    this.doc.on("update", (_update, origin) => {
      const others: readonly unknown[] = [this.#copy.origin, this.#provider, TAKEN_OVER];
      if (!others.includes(origin)) this.#saved.made(); // before it is sent
    });
    this.#copy = new LocalCopy(person, program, this.doc);
    // Tabs do not hand edits to each other: each one's own are sent, counted and called saved by itself.
    this.provider = new WebsocketProvider(serverUrl, program, this.doc, {
      connect: false,
      disableBc: true,
      WebSocketPolyfill: this.#saved.Socket,
    });
    this.#provider = this.provider;
    this.#saved.listen(this.provider.messageHandlers);
    this.compiled = new CompiledForm(this.provider);
    this.#listenToServer();
    void this.#open();
  }

  /**
   * Hear which steps others remove, and which they bring with it, while the document is still the one before; one's own
   * are named to the others.
   */
  onRemoval(listener: (gone: readonly string[], brought: ProgramDocument["steps"]) => void): () => void {
    const steps = this.doc.getMap("steps");
    const note = (event: Y.YMapEvent<unknown>) => {
      const { keys } = event.changes;
      const having = (action: string) => [...keys].filter(([, change]) => change.action === action).map(([id]) => id);
      const gone = having("delete");
      if (gone.length === 0) return;
      if (event.transaction.local) this.awareness.setLocalStateField("removed", gone.slice(0, MOST_REMOVED));
      else listener(gone, rereadSteps(this.doc, {}, new Set(having("add"))));
    };
    steps.observe(note);
    return () => steps.unobserve(note);
  }

  get awareness(): WebsocketProvider["awareness"] {
    return this.provider.awareness;
  }

  /** Empty until all of it is here: half of a program is not shown. */
  readonly getDocument = (): ProgramDocument => (this.#saving.loaded ? this.#document : this.#nothing);
  readonly getSaving = (): Saving => this.#saving;

  /** Whether somebody who removes this step loses a change of ours with it that the server has not seen yet. */
  readonly isUnsaved = (step: string): boolean => this.#unsaved.has(step);

  readonly subscribe = (listener: Listener): (() => void) => {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  };

  readonly subscribeSaving = (listener: Listener): (() => void) => {
    this.#savingListeners.add(listener);
    return () => this.#savingListeners.delete(listener);
  };

  /** One gesture: one transaction, one entry in the undo list; a visit to a field has one for all its transactions. */
  apply(edits: readonly Edit[]): void {
    if (edits.length === 0) return;
    for (const edit of edits) if ("id" in edit) this.#unsaved.add(edit.id);
    // What makes a function says to the undo list that it was not there: a rename says the same otherwise.
    const made = edits.filter(
      (edit) => edit.do === "set_function" && !Object.hasOwn(this.#document.functions, edit.id),
    );
    const kept = [...made.map((edit) => ({ ...edit, value: null }) as Edit), ...edits];
    this.visits.capture(kept, () => applyEditsToDoc(this.doc, edits, this.#origin));
  }

  /** What the program itself puts right after a gesture: no entry of its own in the undo list. */
  adjust(edits: readonly Edit[]): void {
    applyEditsToDoc(this.doc, edits);
    this.undo.adjusted(edits);
  }

  /** Wait until the database holds what is on this screen, also of others: before something is made of the program. */
  async stored(): Promise<void> {
    const seen = Y.encodeSnapshot(Y.snapshot(this.doc));
    await api.post(`/programs/${this.program}/stored`, { seen: buffer.toBase64(seen) });
  }

  /** Try again after a refusal that may have passed. */
  connectAgain(): void {
    this.#setSaving({ connection: "connecting", closedWith: null });
    this.provider.connect();
  }

  /** Give up what waits: the copy in this browser goes. The program is to be opened anew after this. */
  async discard(): Promise<void> {
    this.provider.disconnect();
    await this.#copy.remove();
  }

  close(): void {
    this.#closed = true;
    this.#saved.close();
    this.provider.destroy();
    void this.#copy.close();
    this.doc.destroy();
  }

  /** Connect once the copy is here: the first answer to the server has all that waits, and counts for it. */
  async #open(): Promise<void> {
    const copy = this.#copy.open();
    const late = new Promise<"late">((done) => setTimeout(() => done("late"), PATIENCE_MS));
    const earlier = await Promise.race([copy, late]);
    if (this.#closed) return;
    if (earlier === "late") void copy.then((waiting) => this.#takeLate(waiting));
    else this.#take(earlier);
    this.provider.connect();
  }

  #take(earlier: Waiting): void {
    this.#earlier = earlier.count;
    for (const id of earlier.steps) this.#unsaved.add(id);
    this.#saved.madeBefore(earlier.count);
    this.#setSaving({ loaded: this.#saving.loaded || this.doc.store.clients.size > 0 });
  }

  /** A copy that comes after the connection: what waits in it goes with the first answer of a new one. */
  #takeLate(earlier: Waiting): void {
    if (this.#closed) return;
    const connected = this.#saving.connection !== "refused";
    if (connected) this.provider.disconnect();
    this.#take(earlier);
    if (!connected) return;
    this.provider.connect();
    this.#setSaving({ connection: "connecting" }); // we left ourselves: nobody may say that the server is away
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
    const { waiting, late, refused } = this.#saved;
    const before = this.#saving;
    if (waiting === before.waiting && late === before.late && refused === before.notTaken) return;
    if (waiting === 0) this.#unsaved.clear();
    if (waiting !== before.waiting) this.#keepCount(waiting);
    this.#setSaving({ waiting, late, notTaken: refused });
  }

  /** Beside the copy stands what this page made; what pages before it made stands there until all of it is saved. */
  #keepCount(waiting: number): void {
    if (this.#earlier > 0 && this.#saved.stored > 0) {
      this.#earlier = 0;
      void this.#copy.settle();
    }
    this.#setSaving({ kept: false });
    const keeping = ++this.#keepings;
    void this.#copy.keep({ count: waiting - this.#earlier, steps: [...this.#unsaved] }).then(
      () => keeping === this.#keepings && !this.#closed && this.#setSaving({ kept: true }),
      () => {}, // a browser that keeps nothing never says that it does
    );
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
      else this.#setSaving({ connection: "reconnecting" }); // also when there never was a connection
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
