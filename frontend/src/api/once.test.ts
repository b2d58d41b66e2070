import { afterEach, expect, test, vi } from "vitest";
import { makeOnce } from "./once";

const sent: { key: string | null; body: string }[] = [];
const answers: (() => Promise<Response>)[] = [];
const silent = () => Promise.reject(new TypeError("no network"));
const says = (status: number, body: object) => () => Promise.resolve(new Response(JSON.stringify(body), { status }));

vi.stubGlobal("document", { cookie: "" });
vi.stubGlobal("fetch", (_path: string, asked: { headers: Headers; body: string }) => {
  sent.push({ key: asked.headers.get("Idempotency-Key"), body: asked.body });
  return (answers.shift() ?? silent)();
});

afterEach(() => {
  sent.length = answers.length = 0;
});

test("what is pressed again because nobody answered has the same key, and the next one another", async () => {
  const begin = makeOnce();
  answers.push(silent, says(409, { code: "under_way" }), says(202, { id: "run" }), says(202, { id: "next" }));
  await expect(begin("/programs/p/runs", { a: 1 })).rejects.toThrow();
  await expect(begin("/programs/p/runs", { a: 1 })).rejects.toThrow();
  expect(await begin("/programs/p/runs", { a: 1 })).toEqual({ id: "run" });
  expect(await begin("/programs/p/runs", { a: 1 })).toEqual({ id: "next" });
  const keys = sent.map((each) => each.key);
  expect(keys[0]).toMatch(/^[0-9a-f-]{36}$/);
  expect([keys[1], keys[2]]).toEqual([keys[0], keys[0]]);
  expect(keys[3]).not.toBe(keys[0]);
});

test("what is asked for otherwise, or was refused, has a new key", async () => {
  const begin = makeOnce();
  answers.push(silent, says(409, { code: "outcome_unknown" }), says(202, { id: "run" }));
  await expect(begin("/programs/p/runs", { a: 1 })).rejects.toThrow();
  await expect(begin("/programs/p/runs", { a: 2 })).rejects.toThrow();
  await begin("/programs/p/runs", { a: 2 });
  expect(new Set(sent.map((each) => each.key)).size).toBe(3);
});
