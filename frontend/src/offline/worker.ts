/// <reference lib="webworker" />
/**
 * The service worker: the editor opens and works without the server, for a day. What the server says comes first, always;
 * what is kept is for when it does not answer, belongs to one person and goes when that person signs out.
 */
import { cleanupOutdatedCaches, matchPrecache, precache, addRoute } from "workbox-precaching";
import { NavigationRoute, registerRoute } from "workbox-routing";
import { ANSWERS, changesPerson, isAway, isFresh, isNeeded, ME, personOf, toKeep } from "./kept";

declare const self: ServiceWorkerGlobalScope & {
  readonly __WB_MANIFEST: (string | { url: string; revision: string | null })[];
};

/** A server that does not send its page within this time is worked without. */
const PAGE_MS = 6000;
/** Counts the persons: an answer that was asked for by one before is not kept. */
let round = 0;

precache(self.__WB_MANIFEST);
cleanupOutdatedCaches();
self.addEventListener("install", () => void self.skipWaiting());
self.addEventListener("activate", (event) => event.waitUntil(self.clients.claim()));

// The page itself first: `/index.html` of the shell is for when the server is away only.
registerRoute(new NavigationRoute(({ request }) => openPage(request)));
addRoute({ directoryIndex: "", cleanURLs: false });
registerRoute(
  ({ url, sameOrigin }) => sameOrigin && isNeeded(url),
  ({ request, url }) => answer(request, url),
);
registerRoute(
  ({ url, sameOrigin }) => sameOrigin && changesPerson(url),
  ({ request }) => changePerson(request),
  "POST",
);

async function openPage(request: Request): Promise<Response> {
  const late = new Promise<null>((done) => setTimeout(() => done(null), PAGE_MS));
  const asked = fetch(request).catch(() => null);
  const page = await Promise.race([asked, late]);
  if (page && !isAway(page.status)) return page;
  const kept = await matchPrecache("/index.html").catch(() => undefined);
  return kept ?? page ?? (await asked) ?? Response.error();
}

async function answer(request: Request, url: URL): Promise<Response> {
  const asked = round;
  const told = await fetch(request).catch(() => null);
  if (told && !isAway(told.status)) {
    // A browser that keeps nothing, as its disk is full, say, is one without a copy: what the server says counts all the same.
    await keep(url.pathname, told, asked).catch(() => {});
    return told;
  }
  const kept = await look(url.pathname).catch(() => undefined);
  if (kept && isFresh(kept, Date.now())) return kept;
  return told ?? Response.error();
}

async function keep(path: string, told: Response, asked: number): Promise<void> {
  if (told.status === 401) return forget();
  if (told.status === 403 || told.status === 404) return remove(path);
  if (told.status !== 200) return;
  const known = await keptPerson();
  if (path === ME) {
    const person = await personOf(told);
    if (known !== null && person !== known) await forget();
    if (person === null) return;
  } else if (known === null || asked !== round) return; // nobody knows whose it is
  const kept = await toKeep(path, told, Date.now());
  try {
    await (await caches.open(ANSWERS)).put(path, kept);
  } catch {
    await forget(); // some answers of now beside some of before would show what never was
  }
}

/** Whose answers are kept; null while there are none: the first that is kept says who it is. */
async function keptPerson(): Promise<number | null> {
  const kept = await look(ME);
  return kept ? personOf(kept) : null;
}

/** To look for something makes no cache anew. */
function look(path: string): Promise<Response | undefined> {
  return caches.match(path, { cacheName: ANSWERS });
}

async function changePerson(request: Request): Promise<Response> {
  const told = await fetch(request);
  if (told.ok) await forget().catch(() => {}); // the next answer of `/api/me` tells that somebody else is here
  return told;
}

async function remove(path: string): Promise<void> {
  if (await look(path)) await (await caches.open(ANSWERS)).delete(path);
}

async function forget(): Promise<void> {
  round += 1;
  await caches.delete(ANSWERS);
}
