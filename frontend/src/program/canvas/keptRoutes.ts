/** Routes that this browser keeps beside the other answers of the server, so that a drawing has its ways without it. */
import { ANSWERS } from "@/api/localCopies";

/** So many of a map are kept at most. */
const MOST = 2000;

type Kept<Answer> = Record<string, Answer>;

/** Keep what the server has answered, with what was kept before. */
export async function keepRoutes<Answer>(
  site: string,
  mapVersion: number | undefined,
  answers: Kept<Answer>,
): Promise<void> {
  const cache = await open();
  if (!cache) return;
  const all = Object.entries({ ...(await read<Answer>(cache, site, mapVersion)), ...answers }).slice(-MOST);
  await cache.put(addressOf(site, mapVersion), new Response(JSON.stringify(Object.fromEntries(all))));
}

/** What was kept of the routes on a map; nothing where the browser keeps nothing. */
export async function keptRoutes<Answer>(site: string, mapVersion: number | undefined): Promise<Kept<Answer>> {
  const cache = await open();
  return cache ? read(cache, site, mapVersion) : {};
}

async function open(): Promise<Cache | null> {
  if (!("caches" in globalThis)) return null;
  // Kept beside what says whose it is, and not after that person has gone.
  const known = await caches.match("/api/me", { cacheName: ANSWERS }).catch(() => undefined);
  return known ? caches.open(ANSWERS) : null;
}

async function read<Answer>(cache: Cache, site: string, mapVersion: number | undefined): Promise<Kept<Answer>> {
  const kept = await cache.match(addressOf(site, mapVersion));
  return kept ? ((await kept.json()) as Kept<Answer>) : {};
}

/** No address of the server's. */
function addressOf(site: string, mapVersion: number | undefined): string {
  return `/kept/routes/${encodeURIComponent(site)}/${mapVersion ?? ""}`;
}
