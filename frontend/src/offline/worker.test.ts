/** The service worker of a browser whose store is full, or gives nothing: the server's answers come all the same. */
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { ME } from "./kept";

interface Route {
  readonly match: (of: { url: URL; sameOrigin: boolean }) => boolean;
  readonly run: (of: { request: Request; url: URL }) => Promise<Response>;
  readonly method: string;
}
const routes: Route[] = [];
vi.mock("workbox-precaching", () => ({
  addRoute: () => undefined,
  cleanupOutdatedCaches: () => undefined,
  matchPrecache: () => Promise.resolve(undefined),
  precache: () => undefined,
}));
vi.mock("workbox-routing", () => ({
  NavigationRoute: vi.fn(),
  registerRoute: (match: Route["match"], run?: Route["run"], method = "GET") =>
    run && routes.push({ match, run, method }),
}));

const DEVICES = "/api/sites/works/devices";
/** What the browser keeps. */
let store: Map<string, Response>;
let full: boolean;
let broken: boolean;
let server: (path: string) => Response;

const orFail = () => (broken ? Promise.reject(new DOMException("No store here.", "SecurityError")) : Promise.resolve());
const CACHES = {
  match: (path: string) => orFail().then(() => store.get(path)?.clone()),
  delete: () => orFail().then(() => store.clear()),
  open: () =>
    orFail().then(() => ({
      put: (path: string, answer: Response) =>
        full ? Promise.reject(new DOMException("Quota exceeded.", "QuotaExceededError")) : store.set(path, answer),
      delete: (path: string) => store.delete(path),
    })),
};

/** The status and the body of what a page gets. */
async function ask(path: string, method = "GET"): Promise<readonly [number, unknown]> {
  const url = new URL(path, "https://vipo.example");
  const route = routes.find((each) => each.method === method && each.match({ url, sameOrigin: true }));
  const got = await route?.run({ request: new Request(url, { method }), url });
  return [got?.status ?? 0, got?.ok ? await got.json() : null];
}

beforeEach(async () => {
  store = new Map();
  [full, broken] = [false, false];
  server = (path) => Response.json(path === ME ? { user: { id: 7 } } : { path });
  vi.stubGlobal("self", { addEventListener: () => undefined, __WB_MANIFEST: [] });
  vi.stubGlobal("caches", CACHES);
  vi.stubGlobal("fetch", (request: Request) => Promise.resolve(server(new URL(request.url).pathname)));
  if (routes.length === 0) await import("./worker");
});
afterEach(() => vi.unstubAllGlobals());

test("what the server answered is there when it is away", async () => {
  await ask(ME);
  await ask(DEVICES);
  server = () => new Response(null, { status: 502 });
  expect(await ask(DEVICES)).toEqual([200, { path: DEVICES }]);
});

test("a full store takes no answer from the page, and keeps none of before beside the newer ones", async () => {
  await ask(ME);
  await ask(DEVICES);
  expect([...store.keys()]).toEqual([ME, DEVICES]);
  full = true;
  expect(await ask(ME)).toEqual([200, { user: { id: 7 } }]);
  expect([...store.keys()]).toEqual([]);
  expect(await ask(DEVICES)).toEqual([200, { path: DEVICES }]);
  full = false;
  await ask(ME);
  await ask(DEVICES);
  expect([...store.keys()]).toEqual([ME, DEVICES]);
});

test("a store that refuses everything takes no answer from the page", async () => {
  broken = true;
  expect(await ask(ME)).toEqual([200, { user: { id: 7 } }]);
  expect(await ask(DEVICES)).toEqual([200, { path: DEVICES }]);
  expect((await ask("/api/sign-out", "POST"))[0]).toBe(200);
  server = () => new Response(null, { status: 503 });
  expect(await ask(DEVICES)).toEqual([503, null]);
});
