import { expect, test } from "vitest";
import { A_DAY_MS, changesPerson, isAway, isFresh, isNeeded, KEPT_AT, ME, personOf, toKeep } from "./kept";

const at = (path: string) => new URL(path, "https://vipo.example");

test("what the editor needs to open is kept, and nothing else", () => {
  const needed = ["/api/me", "/api/sites/a", "/api/sites/a/devices", "/api/sites/a/map", "/api/sites/a/map/cells"];
  expect(needed.filter((path) => !isNeeded(at(path)))).toEqual([]);
  const other = [
    "/api/sites",
    "/api/sites/a/devices?lifecycle=retired",
    "/api/runs/1",
    "/api/me/sessions",
    "/api/library",
  ];
  expect(other.filter((path) => isNeeded(at(path)))).toEqual([]);
});

test("signing in and out are calls after which another person may be there", () => {
  const calls = ["/api/sign-in", "/api/sign-out", "/api/me/sign-out-everywhere", "/api/me", "/api/sites/sign-out"];
  expect(calls.filter((path) => changesPerson(at(path)))).toEqual(calls.slice(0, 3));
});

test("only a proxy's answer for a server that is away is as good as none", () => {
  expect([200, 401, 404, 500, 501, 502, 503, 504, 505].filter(isAway)).toEqual([502, 503, 504]);
});

test("an answer is good for a day, and one without a time or from the future is not", () => {
  const kept = (when: string) => new Response("", { headers: { [KEPT_AT]: when } });
  expect(isFresh(kept("1000"), 1000 + A_DAY_MS - 1)).toBe(true);
  expect(isFresh(kept("1000"), 1000 + A_DAY_MS)).toBe(false);
  expect(isFresh(kept("1000"), 999)).toBe(false);
  expect(isFresh(new Response(""), A_DAY_MS)).toBe(false);
});

test("who is signed in is kept without the token and without the demo's passwords", async () => {
  const me = { csrf: "secret", demo_accounts: [{ password: "x" }], user: { id: 7 }, may_create_sites: true };
  const kept = await toKeep(ME, Response.json(me), 5);
  expect(await personOf(kept)).toBe(7);
  expect(await kept.json()).toEqual({ csrf: "", demo_accounts: [], user: { id: 7 }, may_create_sites: true });
  expect(kept.headers.get(KEPT_AT)).toBe("5");
});

test("any other answer is kept byte for byte", async () => {
  const cells = Uint8Array.of(0, 100, 255);
  const kept = await toKeep("/api/sites/a/map/cells", new Response(cells), 5);
  expect(new Uint8Array(await kept.arrayBuffer())).toEqual(cells);
});

test("nobody is nobody", async () => {
  expect(await personOf(Response.json({ user: null }))).toBeNull();
});
