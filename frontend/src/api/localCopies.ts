/**
 * What this browser keeps of people's programs: for each person and program a database of its own, with the document
 * and how many changes of it the server has not called saved. It ends when its person signs out.
 */
import * as idb from "lib0/indexeddb";

const PREFIX = "vipo-copy-";
/** Its entries: for each page that made changes, how many of them are not known to be saved. */
export const COUNTS = "custom";
/** The answers of the server that the service worker keeps (src/offline/worker.ts). */
export const ANSWERS = "vipo-answers";

export interface KeptCopy {
  readonly database: string;
  readonly person: string;
  readonly program: string;
  /** Changes that are not known to be saved. */
  readonly waiting: number;
}

/** The name of the database of a person's copy of a program. */
export function copyOf(person: string, program: string): string {
  return `${PREFIX}${person}-${program}`;
}

/** The name that it had before copies belonged to a person. */
export function oldCopyOf(program: string): string {
  return `vipo-program-${program}`;
}

/** Whether a database is there; asking for one by its name would make it. */
export async function isKept(database: string): Promise<boolean> {
  return (await indexedDB.databases()).some(({ name }) => name === database);
}

/** All copies of programs in this browser, of anybody. */
export async function listCopies(): Promise<readonly KeptCopy[]> {
  const found: KeptCopy[] = [];
  for (const { name = "" } of await indexedDB.databases()) {
    const [, person, program] = /^vipo-copy-(\d+)-(.+)$/.exec(name) ?? [];
    if (person && program) found.push({ database: name, person, program, waiting: await countWaiting(name) });
  }
  return found;
}

async function countWaiting(database: string): Promise<number> {
  const db = await openKept(database);
  if (!db) return 0;
  try {
    if (!db.objectStoreNames.contains(COUNTS)) return 0;
    const [store] = idb.transact(db, [COUNTS], "readonly");
    const counts: unknown[] = store ? await idb.getAll(store) : [];
    return counts.reduce<number>((sum, count) => sum + (typeof count === "number" ? count : 0), 0);
  } finally {
    db.close();
  }
}

/** Open a database; null if it has just gone, since opening would make it anew. */
function openKept(database: string): Promise<IDBDatabase | null> {
  return new Promise((resolve) => {
    const asked = indexedDB.open(database);
    asked.onupgradeneeded = () => asked.transaction?.abort();
    asked.onsuccess = () => {
      const db = asked.result;
      db.onversionchange = () => db.close();
      resolve(db);
    };
    asked.onerror = (event) => {
      event.preventDefault();
      resolve(null);
    };
  });
}

/** Remove copies of programs. */
async function removeCopies(which: (copy: KeptCopy) => boolean): Promise<void> {
  const gone = (await listCopies()).filter(which);
  await Promise.all(gone.map(({ database }) => idb.deleteDB(database)));
}

/** What the server answered, for pages that are opened without it. */
async function removeAnswers(): Promise<void> {
  if ("caches" in globalThis) await caches.delete(ANSWERS);
}

const CLIPPING = "vipo.clipboard.";

/** Where the steps that a person copied last are kept, as they were drawn. */
export function clippingOf(person: string): string {
  return CLIPPING + person;
}

function removeClippings(besides: string | null): void {
  if (!("localStorage" in globalThis)) return;
  for (const name of Object.keys(localStorage))
    if (name.startsWith(CLIPPING) && (besides === null || name !== clippingOf(besides))) localStorage.removeItem(name);
}

/** After signing out: nothing of anybody stays. */
export async function removeAll(): Promise<void> {
  removeClippings(null);
  await removeAnswers();
  await removeCopies(() => true);
  const old = (await indexedDB.databases()).flatMap(({ name = "" }) => (name.startsWith(oldCopyOf("")) ? [name] : []));
  await Promise.all(old.map((name) => idb.deleteDB(name)));
}

/**
 * Keep only what is for whoever is signed in: nothing of anybody else. Of nobody (a session that ended by itself) only
 * what waits stays, until somebody signs in: whose it is can send it then.
 */
export async function keepOnlyOf(person: string | null): Promise<void> {
  removeClippings(person);
  if (person !== null) return removeCopies((copy) => copy.person !== person);
  await removeAnswers();
  await removeCopies((copy) => copy.waiting === 0);
}
