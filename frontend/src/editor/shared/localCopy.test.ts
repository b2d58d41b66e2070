import "fake-indexeddb/auto";
import { afterEach, beforeEach, expect, test } from "vitest";
import { IndexeddbPersistence } from "y-indexeddb";
import * as Y from "yjs";
import { copyOf, keepOnlyOf, listCopies, oldCopyOf, removeAll } from "@/api/localCopies";
import { LocalCopy } from "./localCopy";

const open: LocalCopy[] = [];
beforeEach(removeAll);
afterEach(async () => {
  for (const copy of open.splice(0)) await copy.close();
});

async function page(person: string, program = "p") {
  const doc = new Y.Doc();
  const copy = new LocalCopy(person, program, doc);
  open.push(copy);
  return { doc, copy, waiting: await copy.open() };
}

const counts = async () => (await listCopies()).map(({ person, waiting }) => [person, waiting]);

test("what a page counted waits in the next one, with what it drew, until that is settled", async () => {
  const first = await page("1");
  first.doc.getMap("steps").set("a", 1);
  await first.copy.keep({ count: 2, steps: [] });
  expect(await counts()).toEqual([["1", 2]]);
  await first.copy.close();
  const second = await page("1");
  expect(second.waiting.count).toBe(2);
  expect(second.doc.getMap("steps").get("a")).toBe(1);
  await second.copy.settle();
  expect(await counts()).toEqual([["1", 0]]);
});

test("settling leaves what another page has made since, and its own count", async () => {
  const other = await page("1");
  await other.copy.keep({ count: 1, steps: [] });
  await expect.poll(counts).toEqual([["1", 1]]);
  const mine = await page("1");
  await Promise.all([mine.copy.keep({ count: 4, steps: [] }), other.copy.keep({ count: 2, steps: [] })]);
  await expect.poll(counts).toEqual([["1", 6]]);
  await mine.copy.settle();
  expect(await counts()).toEqual([["1", 6]]);
});

test("another person sees nothing of a copy, and signing in removes it", async () => {
  const first = await page("1");
  first.doc.getMap("steps").set("a", 1);
  await first.copy.keep({ count: 1, steps: [] });
  await expect.poll(counts).toEqual([["1", 1]]);
  const second = await page("2");
  expect(second.doc.getMap("steps").size).toBe(0);
  await keepOnlyOf("2");
  expect(await counts()).toEqual([["2", 0]]);
});

test("a session that ended by itself leaves only what waits", async () => {
  const waits = await page("1", "p");
  await waits.copy.keep({ count: 1, steps: [] });
  await page("1", "q");
  await expect.poll(counts).toContainEqual(["1", 1]);
  await keepOnlyOf(null);
  expect((await listCopies()).map(({ program }) => program)).toEqual(["p"]);
});

test("a copy of before is taken over once, and then gone", async () => {
  const old = new Y.Doc();
  const before = new IndexeddbPersistence(oldCopyOf("p"), old);
  await before.whenSynced;
  old.getMap("steps").set("kept", 1);
  await before.destroy();
  const now = await page("1");
  expect(now.doc.getMap("steps").get("kept")).toBe(1);
  expect((await indexedDB.databases()).map(({ name }) => name)).toEqual([copyOf("1", "p")]);
  await now.copy.close();
  expect((await page("1")).doc.getMap("steps").get("kept")).toBe(1);
});

test("a copy that is discarded is gone from the browser", async () => {
  const { copy } = await page("1");
  await copy.remove();
  expect(await indexedDB.databases()).toEqual([]);
});

test("the steps of what waits are known to the next page, until that is settled", async () => {
  const [first, beside] = [await page("1"), await page("1")];
  await first.copy.keep({ count: 2, steps: ["a", "b"] });
  await beside.copy.keep({ count: 1, steps: ["b", "c"] });
  const next = await page("1");
  expect(next.waiting.count).toBe(3);
  expect([...next.waiting.steps].sort()).toEqual(["a", "b", "c"]);
  await beside.copy.keep({ count: 0, steps: [] });
  expect((await page("1")).waiting).toEqual({ count: 2, steps: ["a", "b"] });
  expect(await counts()).toEqual([["1", 2]]);
  await next.copy.settle();
  expect((await page("1")).waiting).toEqual({ count: 0, steps: [] });
});

test("what is no list of steps is none", async () => {
  const first = await page("1");
  await first.copy.keep({ count: 1, steps: ["a"] });
  const db = await new Promise<IDBDatabase>((done) => {
    const asked = indexedDB.open(copyOf("1", "p"));
    asked.onsuccess = () => done(asked.result);
  });
  for (const nonsense of ["[7, {}]", "{", 7n]) {
    const store = db.transaction("custom", "readwrite").objectStore("custom");
    const key = await new Promise<IDBValidKey | undefined>((done) => {
      const asked = store.getAllKeys();
      asked.onsuccess = () => done(asked.result.find((each) => typeof each === "string" && each.startsWith("steps-")));
    });
    await new Promise((done) => (store.put(nonsense, key).onsuccess = done));
    expect((await page("1")).waiting).toEqual({ count: 1, steps: [] });
  }
  db.close();
});

test("what is kept and settled at once leaves nothing", async () => {
  const { copy } = await page("1");
  await Promise.all([copy.keep({ count: 1, steps: ["a"] }), copy.keep({ count: 0, steps: [] })]);
  expect((await page("1")).waiting).toEqual({ count: 0, steps: [] });
  await Promise.all([copy.keep({ count: 0, steps: [] }), copy.keep({ count: 2, steps: ["b"] })]);
  expect((await page("1")).waiting).toEqual({ count: 2, steps: ["b"] });
});
