/** What the service worker keeps, for how long, and of whom: no code of the browser, so that tests can read it. */

/** The cache of what the server answered; src/api/localCopies.ts removes it at signing out. */
export const ANSWERS = "vipo-answers";
export const A_DAY_MS = 24 * 3600 * 1000;
/** When an answer was kept: a header that it gets here. */
export const KEPT_AT = "X-Kept-At";
export const ME = "/api/me";

const PART = "[^/]+";
/** What the editor reads before it can show a program that was open before. */
const NEEDED = [
  ME,
  `/api/sites/${PART}`,
  `/api/sites/${PART}/devices`,
  `/api/sites/${PART}/map`,
  `/api/sites/${PART}/map/cells`,
  `/api/programs/${PART}`,
].map((path) => new RegExp(`^${path}$`));
/** After these calls somebody else may be signed in, or nobody. */
const CHANGES_PERSON = /^\/api\/(sign-in|sign-out|me\/sign-out-everywhere)$/;

export function isNeeded(url: URL): boolean {
  return url.search === "" && NEEDED.some((path) => path.test(url.pathname));
}

export function changesPerson(url: URL): boolean {
  return CHANGES_PERSON.test(url.pathname);
}

/** Whether an answer means that the server itself is not there: a proxy answers for it. */
export function isAway(status: number): boolean {
  return status >= 502 && status <= 504;
}

export function isFresh(answer: Response, now: number): boolean {
  const age = now - Number(answer.headers.get(KEPT_AT) ?? 0);
  return age >= 0 && age < A_DAY_MS;
}

/** Who is signed in, as an answer of `/api/me` says; null for nobody. */
export async function personOf(answer: Response): Promise<number | null> {
  const me = (await answer.clone().json()) as { user?: { id?: number } | null };
  return me.user?.id ?? null;
}

/** The answer as it is kept: when, and without what is only good for the moment or for a secret. */
export async function toKeep(path: string, answer: Response, now: number): Promise<Response> {
  const headers = new Headers(answer.headers);
  headers.set(KEPT_AT, String(now));
  headers.delete("Content-Encoding"); // the body is read already
  headers.delete("Content-Length");
  if (path !== ME) return new Response(await answer.clone().arrayBuffer(), { status: answer.status, headers });
  const me = (await answer.clone().json()) as Record<string, unknown>;
  return new Response(JSON.stringify({ ...me, csrf: "", demo_accounts: [] }), { status: answer.status, headers });
}
