/** Maps as they come in two answers, a header and its cells, which must be of the same map. */
import { api } from "./client";

/** Between two answers a map may be followed by another, again and again; no robot sends them so quickly. */
const MOST_TRIES = 4;

interface Header {
  version: number;
  /** Not in one that the browser has kept since the version before of VIPO. */
  tag?: string;
}

/** Whether cells are those of a header: by its tag, which a proxy may have made a weak one (`W/` before it). */
export const areOf = (info: Header, tag: string) => tag.endsWith(info.tag ?? `-${info.version}"`);

/** Whether two headers are of the same map; of two without a tag that is told by their numbers alone. */
export const isSameMap = (a: Header, b: Header) => a.version === b.version && a.tag === b.tag;

/**
 * A map with its cells; the cells are at `/cells` behind its path.
 * Both are fetched anew where they do not belong together; where a proxy takes the tags away, nobody can tell.
 */
export async function getWholeMap<T extends Header>(path: string): Promise<T & { cells: Uint8Array }> {
  for (let tries = 1; tries <= MOST_TRIES; tries++) {
    const [info, { tag, bytes }] = await Promise.all([api.get<T>(path), api.tagged(`${path}/cells`)]);
    if (tag === "" || areOf(info, tag)) return { ...info, cells: bytes };
  }
  throw new Error(`What is at ${path} changes while it is fetched.`);
}
