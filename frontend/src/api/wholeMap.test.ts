import { afterEach, expect, test, vi } from "vitest";
import { getWholeMap, isSameMap } from "./wholeMap";

afterEach(() => vi.unstubAllGlobals());

const PATH = "/sites/hall/devices/scout/map";

/** A robot's map of n cells in its version n; another comes behind each of so many of the answers with a header. */
function growing(times: number, tagged = (tag: string): string | null => tag) {
  let version = 1;
  const asked: string[] = [];
  const answer = (address: string) => {
    asked.push(address);
    const [now, tag] = [version, `"scout-${String(version)}-5"`];
    if (address.endsWith("/cells")) {
      const sent = tagged(tag);
      return new Response(new Uint8Array(now), sent === null ? {} : { headers: { ETag: sent } });
    }
    if (version <= times) version++;
    return new Response(JSON.stringify({ version: now, width: now, height: 1, tag }));
  };
  vi.stubGlobal("fetch", (address: string) => Promise.resolve(answer(address)));
  return asked;
}

test("a map that is followed by another between the two answers is fetched anew until both are of one", async () => {
  const asked = growing(2);
  const map = await getWholeMap<{ version: number; width: number; height: number }>(PATH);
  expect([map.width, map.cells.length]).toEqual([3, 3]);
  expect(asked).toHaveLength(6);
});

test("one that does not change is asked for once, whether or not a proxy has touched its tag", async () => {
  for (const tagged of [(tag: string) => tag, (tag: string) => `W/${tag}`, () => null]) {
    const asked = growing(0, tagged);
    expect((await getWholeMap<{ version: number }>(PATH)).cells).toHaveLength(1);
    expect(asked).toEqual([`/api${PATH}`, `/api${PATH}/cells`]);
  }
});

test("one that never rests is a failure, no skewed picture", async () => {
  const asked = growing(Infinity);
  await expect(getWholeMap(PATH)).rejects.toThrow(PATH);
  expect(asked).toHaveLength(8);
});

test("two maps are the same by tag and number: a map of the version before has no tag", () => {
  const [first, second] = [{ version: 1 }, { version: 2 }];
  expect([isSameMap(first, first), isSameMap(first, second)]).toEqual([true, false]);
  expect(isSameMap({ version: 1, tag: '"hall-1-0"' }, { version: 1, tag: '"hall-1-4"' })).toBe(false);
  expect(isSameMap(first, { version: 1, tag: '"hall-1-4"' })).toBe(false);
});
