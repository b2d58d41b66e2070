/** A person's copy of a program in this browser, and how many changes in it the server has not called saved. */
import * as idb from "lib0/indexeddb";
import { IndexeddbPersistence } from "y-indexeddb";
import * as Y from "yjs";
import { COUNTS, copyOf, isKept, oldCopyOf } from "@/api/localCopies";

/** Where y-indexeddb keeps the document. */
const UPDATES = "updates";
/** What comes out of a copy of before, which belonged to nobody, is kept in this one, and no change of one's own. */
export const TAKEN_OVER = Symbol("taken over");

/** What pages before this one made and did not hear about. */
export interface Waiting {
  readonly count: number;
  /** The steps that it concerns. */
  readonly steps: readonly string[];
}

const NOTHING: Waiting = { count: 0, steps: [] };
/** Before a page's name: the steps of its changes, as JSON beside their number. */
const STEPS = "steps-";

export class LocalCopy {
  /** Whose changes are not one's own: they are in the copy. */
  readonly origin: unknown;
  readonly #persistence: IndexeddbPersistence;
  /** Each page counts its own: several of one person may be open. */
  readonly #page = crypto.randomUUID();
  #before = new Map<string, number>();

  constructor(
    person: string,
    private readonly program: string,
    private readonly doc: Y.Doc,
  ) {
    this.#persistence = new IndexeddbPersistence(copyOf(person, program), doc);
    this.origin = this.#persistence;
  }

  /** Read the copy into the document; returns which changes of pages before wait in it. */
  open(): Promise<Waiting> {
    return this.#read().catch(() => NOTHING);
  }

  async #read(): Promise<Waiting> {
    // Counted first: what another page adds between the two is not called saved too early.
    for (const [page, count] of await this.#counts()) this.#before.set(page, count);
    const pages = [...this.#before.keys()];
    const lists = await Promise.all(pages.map((page) => this.#persistence.get(STEPS + page)));
    await this.#persistence.whenSynced;
    await takeOver(this.program, this.doc);
    const count = [...this.#before.values()].reduce((sum, each) => sum + each, 0);
    return { count, steps: [...new Set(lists.flatMap(stepsOf))] };
  }

  /**
   * Keep how many changes of this page wait, and of which steps; done when they are in the copy, and so is this: a page
   * that is closed before may take them along. Fails where the browser keeps nothing.
   */
  async keep({ count, steps }: Waiting): Promise<void> {
    const persistence = this.#persistence;
    // All is asked for at once, in this order: what is kept next must not come between.
    await (count > 0
      ? Promise.all([persistence.set(STEPS + this.#page, JSON.stringify(steps)), persistence.set(this.#page, count)])
      : this.#forget(this.#page));
    await persistence.whenSynced;
    const db = await persistence._db;
    // Has its turn when all that was to be written before has been.
    const [updates] = idb.transact(db, [UPDATES, COUNTS], "readonly");
    if (updates) await idb.count(updates);
  }

  /** What pages before this one had made is saved; a page that has made more since still counts its own. */
  async settle(): Promise<void> {
    const before = this.#before;
    if (before.size === 0) return;
    this.#before = new Map();
    for (const [page, count] of await this.#counts()) if (before.get(page) === count) await this.#forget(page);
  }

  async #forget(page: string): Promise<void> {
    await Promise.all([this.#persistence.del(page), this.#persistence.del(STEPS + page)]);
  }

  /** Remove the copy; the document itself stays as it is. */
  async remove(): Promise<void> {
    await this.#persistence.destroy();
    await idb.deleteDB(this.#persistence.name);
  }

  async close(): Promise<void> {
    await this.#persistence.destroy();
  }

  async #counts(): Promise<readonly (readonly [string, number])[]> {
    const db = await this.#persistence._db;
    const [store] = idb.transact(db, [COUNTS], "readonly");
    const kept: { k: unknown; v: unknown }[] = store ? await idb.getAllKeysValues(store) : [];
    return kept.flatMap(({ k, v }) => (typeof v === "number" ? [[String(k), v] as const] : []));
  }
}

/** What a page wrote down; nothing of what a page of another version means by it. */
function stepsOf(kept: unknown): string[] {
  try {
    const read: unknown = typeof kept === "string" ? JSON.parse(kept) : [];
    return Array.isArray(read) ? read.filter((each) => typeof each === "string") : [];
  } catch {
    return [];
  }
}

/** Once: what a copy of before holds becomes part of the document, then that copy goes. */
async function takeOver(program: string, doc: Y.Doc): Promise<void> {
  const name = oldCopyOf(program);
  if (!(await isKept(name))) return;
  const old = new Y.Doc();
  const persistence = new IndexeddbPersistence(name, old);
  await persistence.whenSynced;
  Y.applyUpdate(doc, Y.encodeStateAsUpdate(old), TAKEN_OVER);
  await persistence.destroy();
  old.destroy();
  await idb.deleteDB(name);
}
