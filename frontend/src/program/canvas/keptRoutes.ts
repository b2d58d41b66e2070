/** Routes that this browser keeps beside the other answers of the server, so that a drawing has its ways without it. */
import { ANSWERS } from "@/api/localCopies";

/** So many of a map are kept at most. */
const MOST = 2000;

type Kept<Answer> = Record<string, Answer>;

/** Keep what the server has answered, with what was kept before. */
export async function keepRoutes<Answer>(
  site: string,
  floor: string | undefined,
  answers: Kept<Answer>,
): Promise<void> {
  const cache = await open();
  if (!cache) return;
  const all = Object.entries({ ...(await read<Answer>(cache, site, floor)), ...answers }).slice(-MOST);
  await cache.put(addressOf(site, floor), new Response(JSON.stringify(Object.fromEntries(all))));
}

/** What was kept of the routes on a map; nothing where the browser keeps nothing. */
export async function keptRoutes<Answer>(site: string, floor: string | undefined): Promise<Kept<Answer>> {
  const cache = await open();
  return cache ? read(cache, site, floor) : {};
}

async function open(): Promise<Cache | null> {
  if (!("caches" in globalThis)) return null;
  // Kept beside what says whose it is, and not after that person has gone.
  const known = await caches.match("/api/me", { cacheName: ANSWERS }).catch(() => undefined);
  return known ? caches.open(ANSWERS) : null;
}

async function read<Answer>(cache: Cache, site: string, floor: string | undefined): Promise<Kept<Answer>> {
  const kept = await cache.match(addressOf(site, floor));
  return kept ? ((await kept.json()) as Kept<Answer>) : {};
}

/** No address of the server's. */
function addressOf(site: string, floor: string | undefined): string {
  return `/kept/routes/${encodeURIComponent(site)}/${encodeURIComponent(floor ?? "")}`;
}
