// @vitest-environment jsdom
import { QueryClientProvider } from "@tanstack/react-query";
import { cleanup, renderHook, waitFor } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, expect, test, vi } from "vitest";
import { isNeeded } from "@/offline/kept";
import { makeQueryClient, useSiteMap } from "./queries";
import { areOf } from "./wholeMap";

afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
});

/** A site's maps, of which version n has the one cell n, n + 1 in the next story, after a backup came back; `saves` are versions that somebody saves as the address is answered. */
function mapServer(saves: Readonly<Record<string, number>>) {
  const saved = { version: 1, story: 0 };
  const asked: string[] = [];
  const answer = (address: string) => {
    const path = address.replace("/api/sites/hall", "");
    asked.push(path);
    const holds = saved.version;
    saved.version = saves[path] ?? holds;
    const version = Number(/versions\/(\d+)/.exec(path)?.[1] ?? holds);
    const tag = `"hall-${version}-${saved.story}"`;
    if (!path.endsWith("/cells")) return new Response(JSON.stringify({ version, tag }));
    return new Response(new Uint8Array([version + saved.story]), { headers: { ETag: tag } });
  };
  vi.stubGlobal("fetch", (address: string) => Promise.resolve(answer(address)));
  return { asked, saved };
}

function openMap() {
  const queries = makeQueryClient();
  const around = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={queries}>{children}</QueryClientProvider>
  );
  return renderHook(() => useSiteMap("hall"), { wrapper: around }).result;
}

test("a map that is saved between the two answers of a first visit is shown with its own cells", async () => {
  const { asked } = mapServer({ "/map": 2 });
  const shown = openMap();
  await waitFor(() => expect(shown.current.data).toBeDefined());
  expect([shown.current.data?.version, shown.current.data?.cells]).toEqual([1, new Uint8Array([1])]);
  expect(asked).toEqual(["/map", "/map/cells", "/map/versions/1/cells"]);
});

test("so is one that is saved while a newer one than the known is fetched", async () => {
  const { asked, saved } = mapServer({});
  const shown = openMap();
  await waitFor(() => expect(shown.current.data).toBeDefined());
  expect(asked).toEqual(["/map", "/map/cells"]); // the usual opening
  saved.version = 2;
  asked.length = 0;
  vi.stubGlobal(
    "fetch",
    after(fetch, "/api/sites/hall/map", () => (saved.version = 3)),
  );
  await shown.current.refetch();
  await waitFor(() => expect(shown.current.data?.version).toBe(2));
  expect(shown.current.data?.cells).toEqual(new Uint8Array([2]));
  expect(asked).toEqual(["/map", "/map/cells", "/map/versions/2/cells"]);
});

test("a newer map is fetched from where the browser keeps one for the time without its server", async () => {
  const { asked, saved } = mapServer({});
  const shown = openMap();
  await waitFor(() => expect(shown.current.data).toBeDefined());
  saved.version = 2;
  await shown.current.refetch();
  await waitFor(() => expect(shown.current.data?.cells).toEqual(new Uint8Array([2])));
  expect(asked.filter((path) => !isNeeded(new URL(`http://vipo/api/sites/hall${path}`)))).toEqual([]);
});

test("a map that was kept by the version before is shown with its cells", () => {
  expect(areOf({ version: 3 }, 'W/"hall-3"')).toBe(true);
  expect(areOf({ version: 3 }, '"hall-13"')).toBe(false);
});

test("a map of the same number after a backup came back is not shown with the cells of the lost one", async () => {
  const { saved } = mapServer({});
  const shown = openMap();
  await waitFor(() => expect(shown.current.data?.cells).toEqual(new Uint8Array([1])));
  saved.story = 1;
  await shown.current.refetch();
  await waitFor(() => expect(shown.current.data?.cells).toEqual(new Uint8Array([2])));
});

test("a newer map is not shown with the cells of the known one where a browser has kept both without a tag", async () => {
  let version = 1;
  vi.stubGlobal("fetch", (address: string) =>
    Promise.resolve(address.endsWith("/cells") ? cellsOf(version) : Response.json({ version })),
  );
  const shown = openMap();
  await waitFor(() => expect(shown.current.data?.cells).toEqual(new Uint8Array([1])));
  version = 2;
  await shown.current.refetch();
  await waitFor(() => expect(shown.current.data?.version).toBe(2));
  expect(shown.current.data?.cells).toEqual(new Uint8Array([2]));
});

const cellsOf = (version: number) =>
  new Response(new Uint8Array([version]), { headers: { ETag: `"hall-${version}"` } });

function after(ask: typeof fetch, address: string, then: () => void): typeof fetch {
  return async (path, init) => {
    const answer = await ask(path, init);
    if (path === address) then();
    return answer;
  };
}
