import { QueryClient, QueryObserver } from "@tanstack/react-query";
import { afterEach, beforeEach, expect, test } from "vitest";
import { LiveCaches } from "./caches";

const KEY = ["run-events", "1"];
let queries: QueryClient;
let caches: LiveCaches;
let answers: ((lines: string[] | Promise<string[]>) => void)[];
let leave: () => void;

/** Somebody looks at the query; each fetch waits until the test answers it. */
function look(): void {
  const queryFn = () => new Promise<string[]>((resolve) => answers.push(resolve));
  leave = new QueryObserver(queries, { queryKey: KEY, queryFn, retry: false }).subscribe(() => undefined);
}

async function answer(fetch: number, lines: string[] | Promise<string[]>): Promise<void> {
  answers[fetch]?.(lines);
  await new Promise((resolve) => setTimeout(resolve));
}

const shown = () => queries.getQueryData(KEY);
const add = (line: string) => caches.write<string[]>(KEY, (lines) => (lines.includes(line) ? lines : [...lines, line]));

beforeEach(() => {
  queries = new QueryClient();
  caches = new LiveCaches(queries);
  answers = [];
  look();
});
afterEach(() => {
  leave();
  caches.end();
  queries.clear();
});

test("news that come before the first answer are not lost", async () => {
  add("finished");
  expect(shown()).toBeUndefined();
  await answer(0, ["began"]);
  expect(shown()).toEqual(["began", "finished"]);
});

test("an older answer does not undo what came while it was under way", async () => {
  await answer(0, ["began"]);
  caches.refresh(KEY);
  add("finished");
  expect(shown()).toEqual(["began", "finished"]);
  await answer(1, ["began"]);
  expect(shown()).toEqual(["began", "finished"]);
});

test("news are put into one answer only", async () => {
  add("finished");
  await answer(0, ["began"]);
  caches.refresh(KEY);
  await answer(1, ["other"]);
  expect(shown()).toEqual(["other"]);
});

test("what was missed during the first fetch is fetched after it", async () => {
  caches.refresh(KEY);
  expect(answers).toHaveLength(1);
  await answer(0, ["began"]);
  expect(answers).toHaveLength(2);
  await answer(1, ["began", "finished"]);
  expect([shown(), answers.length]).toEqual([["began", "finished"], 2]);
});

test("news that came while a fetch failed are not put on a newer answer", async () => {
  await answer(0, ["began"]);
  caches.refresh(KEY);
  add("paused");
  await answer(1, Promise.reject(new Error("away")));
  expect(shown()).toEqual(["began", "paused"]);
  caches.refresh(KEY);
  await answer(2, ["began", "went on"]);
  expect(shown()).toEqual(["began", "went on"]);
});

test("what was missed during a first fetch that failed is in the answer to the second", async () => {
  caches.refresh(KEY);
  await answer(0, Promise.reject(new Error("away")));
  caches.refresh(KEY);
  await answer(1, ["began"]);
  expect([shown(), answers.length]).toEqual([["began"], 2]);
});

test("nothing is kept for what nobody asked for", () => {
  caches.write<string[]>(["run-events", "2"], (lines) => lines);
  expect(queries.getQueryCache().find({ queryKey: ["run-events", "2"] })).toBeUndefined();
});
